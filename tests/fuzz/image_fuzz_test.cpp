// Images of labels and of grey values in every format, spoilt: they are read, or refused in a sentence that names the
// file.
#include "tests/fuzz/spoil.hpp"
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

}  // namespace
}  // namespace palpate
