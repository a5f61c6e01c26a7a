// Images of labels and of grey values in every format, spoilt: they are read, or refused in a sentence that names the
// file.
#include "tests/fuzz/spoil.hpp"
#include "tests/organ/dicom_for_tests.hpp"
#include "tests/organ/images_for_tests.hpp"
#include "tests/organ/phantom_image.hpp"
#include "tools/organ/label_volume.hpp"

namespace palpate {
namespace {

using namespace testing;

TEST(ImageFuzz, AnImageIsReadOrRefusedInWords) {
  std::string voxels;
  for (int i = 0; i < 12; ++i) voxels += static_cast<char>(i);
  const std::vector<Sample> samples{{"a.inr", inr_header({3, 2, 2}, {1, 2, 3}) + voxels},
                                    {"b.mha", meta_header() + voxels},
                                    {"c.nrrd", nrrd_header() + voxels},
                                    {"d.nii", nifti_header() + voxels}};
  spoil_all(samples, 400, 5, [](const std::filesystem::path& file) {
    const bool labels = reads(file, [&] {
      const LabelVolume volume = read_label_volume(file);
      EXPECT_EQ(volume.value.size(), volume.shape.size());
      EXPECT_GT(volume.shape.spacing.minCoeff(), 0);
    });
    return reads(file, [&] { read_grey_volume(file); }) || labels;
  });
}

TEST(DicomFuzz, ASeriesWithASpoiltSliceIsReadOrRefusedInWords) {
  const TemporaryFolder folder;
  std::string slice;
  for (int k = 0; k < 3; ++k) {
    const std::string bytes = DicomPicture("1.2.3.4", k, 3 * k, 3, std::string(6, static_cast<char>(k))).bytes();
    write_bytes(folder / std::to_string(k), {bytes.begin(), bytes.end()}, bytes.size());
    if (k == 1) slice = bytes;
  }
  TextSpoiler spoiler(7);
  int whole = 0, done = 0;
  fuzz(100, 1, [&](int round) {
    std::string bytes = spoiler.spoil(slice);
    for (int more = round % 3; more > 0; --more) bytes = spoiler.spoil(bytes);
    write_bytes(folder / "1", {bytes.begin(), bytes.end()}, bytes.size());
    SCOPED_TRACE(fmt::format("round {}", round));
    whole += reads(folder.path(), [&] { read_label_volume(folder.path()); });
    ++done;
  });
  fmt::print("{} series, {} of them read\n", done, whole);
  EXPECT_LT(whole, done);
}

}  // namespace
}  // namespace palpate
