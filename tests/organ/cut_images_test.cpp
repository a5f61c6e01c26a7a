#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>

#include "tests/organ/images_for_tests.hpp"
#include "tests/organ/surfaces_for_tests.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/organ/label_volume.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;

constexpr int kAlong = 24;  // voxels

/// An image of bytes of chance, which do not compress: where its file is cut, voxels are lost.
class CutImages : public ::testing::Test {
 protected:
  void SetUp() override {
    std::uint32_t state = 1;
    for (int i = 0; i < kAlong * kAlong * kAlong; ++i)
      voxels_ += static_cast<char>((state = state * 1664525 + 1013904223) >> 25);
    try {
      read_label_volume(write_file(folder_ / "none.nrrd", ""));
    } catch (const std::runtime_error& error) {
      if (std::string(error.what()).find("without ITK") != std::string::npos) GTEST_SKIP() << error.what();
    }
  }

  /// NIfTI-1 of that size, in either order of bytes.
  static std::string nifti(bool big_endian = false) {
    std::string bytes = nifti_header();
    for (const std::size_t at : {42, 44, 46}) bytes.replace(at, 2, std::string{kAlong, '\0'});
    if (!big_endian) return bytes;
    const auto turn = [&](std::size_t at, std::size_t size, int count) {
      for (int i = 0; i < count; ++i, at += size) std::reverse(bytes.begin() + at, bytes.begin() + at + size);
    };
    turn(0, 4, 1), turn(40, 2, 8), turn(68, 2, 4), turn(76, 4, 11), turn(252, 2, 2), turn(256, 4, 18);
    return bytes;
  }
  /// With compressed voxels, in the file `data` or, where that is "LOCAL", here.
  static std::string meta(const std::string& packed, const std::string& data = "LOCAL") {
    const std::string more = fmt::format("NDims = 3\nCompressedData = True\nCompressedDataSize = {}\n", packed.size());
    const std::string header =
        replaced(replaced(replaced(meta_header(), "3 2 2", "24 24 24"), "NDims = 3\n", more), "LOCAL", data);
    return data == "LOCAL" ? header + packed : header;
  }
  static std::string without_last(const std::string& bytes, std::size_t count) {
    return bytes.substr(0, bytes.size() - count);
  }
  static std::string zlib(const std::string& bytes) {
    std::string packed(compressBound(bytes.size()), '\0');
    uLongf size = packed.size();
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
             bytes.size());
    return packed.substr(0, size);
  }
  std::string gzip(const std::string& bytes) const {
    const auto file = (folder_ / "packed").string();
    const gzFile out = gzopen(file.c_str(), "wb");
    gzwrite(out, bytes.data(), static_cast<unsigned>(bytes.size()));
    gzclose(out);
    return text_of(file);
  }

  void expect_whole(const std::string& name, const std::string& bytes) const {
    const LabelVolume volume = read_label_volume(write_file(folder_ / name, bytes));
    std::string read(volume.value.begin(), volume.value.end());
    if (volume.value[0] != voxels_[0])  // a mirrored image is turned right-handed
      for (std::size_t row = 0; row < read.size(); row += kAlong)
        std::reverse(read.begin() + row, read.begin() + row + kAlong);
    EXPECT_TRUE(read == voxels_) << name;
  }
  void expect_refused(const std::string& name, const std::string& bytes, const std::string& said) const {
    const auto file = write_file(folder_ / name, bytes);
    for (const bool grey : {false, true}) try {
        grey ? void(read_grey_volume(file)) : void(read_label_volume(file));
        ADD_FAILURE() << name << " was read";
      } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find(name + ": " + said), std::string::npos) << error.what();
      }
  }

  std::string voxels_;
  const OwnFolder folder_{"cut-images"};
};

constexpr const char* kCutWords = "it ends before its last voxel";
constexpr const char* kBrokenWords = "its compressed bytes are broken";

TEST_F(CutImages, ANiftiFileThatIsCutShortIsRefused) {
  for (const bool big_endian : {false, true}) {
    const std::string whole = nifti(big_endian) + voxels_, packed = gzip(whole);
    expect_whole("whole.nii", whole);
    expect_whole("whole.nii.gz", packed);
    expect_refused("cut.nii", without_last(whole, 1), kCutWords);
    expect_refused("within.nii.gz", gzip(without_last(whole, 1)), kCutWords);
    expect_refused("half.nii.gz", packed.substr(0, packed.size() / 2), kCutWords);
    expect_refused("header.nii", whole.substr(0, 340), "it ends within its header");
    std::string broken = packed;
    broken[packed.size() - 6] ^= 1;  // its check sum
    expect_refused("broken.nii.gz", broken, kBrokenWords);
  }
}

TEST_F(CutImages, ACompressedMetaImageThatIsCutShortIsRefused) {
  const std::string packed = zlib(voxels_), half = packed.substr(0, packed.size() / 2);
  expect_whole("whole.mha", meta(packed));
  expect_whole("gzip.mha", meta(gzip(voxels_)));
  expect_refused("half.mha", without_last(meta(packed), packed.size() - half.size()), kCutWords);
  expect_refused("told.mha", meta(half), kCutWords);
  expect_refused("within.mha", meta(zlib(without_last(voxels_, 1))), kCutWords);
  std::string broken = packed;
  broken.back() ^= 1;
  expect_refused("broken.mha", meta(broken), kBrokenWords);
  const std::string size = fmt::format("CompressedDataSize = {}\n", packed.size());
  expect_refused("size.mha", replaced(meta(packed), size, ""), "its header lacks CompressedDataSize");
  write_file(folder_ / "beside.zraw", packed);
  expect_whole("beside.mhd", meta(packed, "beside.zraw"));
  write_file(folder_ / "beside.zraw", half);
  expect_refused("beside.mhd", meta(packed, "beside.zraw"), kCutWords);
}

TEST_F(CutImages, AMetaImageWithItsVoxelsBesideItThatIsCutShortIsRefused) {
  const std::string header = replaced(replaced(meta_header(), "3 2 2", "24 24 24"), "LOCAL", "beside.raw");
  write_file(folder_ / "beside.raw", voxels_);
  expect_whole("raw.mhd", header);
  expect_refused("header.mhd", replaced(header, "NDims", "HeaderSize = 1\nNDims"), kCutWords);
  write_file(folder_ / "beside.raw", without_last(voxels_, 1));
  expect_refused("raw.mhd", header, kCutWords);
}

TEST_F(CutImages, HeadersThatAnnounceWhatNoFileHoldsAreRefused) {
  std::string huge = nifti();
  huge.replace(40, 2, std::string{7, '\0'});
  for (std::size_t at = 42; at < 56; at += 2) huge.replace(at, 2, "\xff\x7f");
  expect_refused("huge.nii", huge + voxels_, kCutWords);
  expect_refused("huge.nii.gz", gzip(huge + voxels_), kCutWords);
  std::string far = nifti() + voxels_;
  far.replace(108, 4, std::string("\xff\xff\x7f\x7f", 4));  // voxels that begin at 3e38
  expect_refused("far.nii", far, kCutWords);
}

TEST_F(CutImages, ANiftiFileInOtherUnitsThanMillimetresIsRefused) {
  for (const auto& [units, name] : {std::pair{'\1', "metres"}, {'\3', "micrometres"}}) {
    std::string bytes = nifti() + voxels_;
    bytes[123] = units;
    expect_refused("units.nii", bytes, std::string("its lengths are in ") + name);
  }
  std::string unsaid = nifti() + voxels_;
  unsaid[123] = 0;
  expect_whole("unsaid.nii", unsaid);
}

}  // namespace
}  // namespace palpate
