#include "tools/organ/label_volume.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/organ/dicom_for_tests.hpp"
#include "tests/organ/surfaces_for_tests.hpp"
#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;

/// Two layers of 3 x 2 voxels, numbered, of 1 x 2 x 3 mm.
class LabelImages : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < 12; ++i) voxels_ += static_cast<char>(i);
    try {
      read_label_volume(write_file(folder_ / "none.nrrd", ""));
    } catch (const std::runtime_error& error) {
      if (std::string(error.what()).find("without ITK") != std::string::npos) GTEST_SKIP() << error.what();
    }
  }
  std::string mha(const std::string& first_axis) const {
    return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nTransformMatrix = " +
           first_axis + " 0 0 0 1 0 0 0 1\nOffset = 10 20 30\nElementSpacing = 1 2 3\nDimSize = 3 2 2\n" +
           "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n" + voxels_;
  }
  /// Where the voxel of this label lies in the world [m].
  static Eigen::Vector3d place(const LabelVolume& v, int label) {
    for (int k = 0; k < v.shape.count[2]; ++k)
      for (int j = 0; j < v.shape.count[1]; ++j)
        for (int i = 0; i < v.shape.count[0]; ++i)
          if (v.value[v.shape.index(i, j, k)] == label) return v.in_world(v.shape.place(i, j, k));
    return Eigen::Vector3d::Constant(99);
  }
  std::string voxels_;
  const OwnFolder folder_{"label-images"};
};

TEST_F(LabelImages, MetaImageAndNrrdHaveTheirVoxelsWhereTheirHeadersSay) {
  const LabelVolume meta = read_label_volume(write_file(folder_ / "a.mha", mha("1")));
  EXPECT_TRUE(place(meta, 11).isApprox(Eigen::Vector3d(0.012, 0.022, 0.033))) << place(meta, 11).transpose();
  const LabelVolume nrrd = read_label_volume(write_file(
      folder_ / "a.nrrd",
      "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 2\nspacings: 1 2 3\nencoding: raw\nendian: little\n\n" +
          voxels_));
  EXPECT_TRUE(place(nrrd, 11).isApprox(Eigen::Vector3d(0.002, 0.002, 0.003))) << place(nrrd, 11).transpose();
}

TEST_F(LabelImages, AMirroredImageIsTurnedRightHandedAndStaysInPlace) {
  const LabelVolume mirrored = read_label_volume(write_file(folder_ / "m.mha", mha("-1")));
  EXPECT_GT(mirrored.turn.determinant(), 0);
  EXPECT_TRUE(place(mirrored, 11).isApprox(Eigen::Vector3d(0.008, 0.022, 0.033))) << place(mirrored, 11).transpose();
}

TEST_F(LabelImages, OfAFolderWithSeveralDicomSeriesOneIsChosen) {
  std::filesystem::create_directories(folder_ / "series");
  const auto write = [&](const std::string& series, int number) {
    write_file(folder_ / ("series/" + series + "-" + std::to_string(number)),
               DicomPicture(series, number, 30 + 3 * number, 3, voxels_.substr(6 * number, 6)).bytes());
  };
  write("1.2.3.4", 0), write("1.2.3.4", 1);
  const auto read = [&](const std::string& series) { return read_label_volume(folder_ / "series", series); };
  const LabelVolume alone = read("");
  EXPECT_EQ(alone.shape.count, (std::array{3, 2, 2}));
  EXPECT_TRUE(place(alone, 11).isApprox(Eigen::Vector3d(0.012, 0.022, 0.033))) << place(alone, 11).transpose();
  write("1.2.3.5", 0);
  try {
    read("");
    FAIL() << "one of two series was taken unasked";
  } catch (const std::runtime_error& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("2 DICOM series lie in this folder, choose by --series: 1.2.3.4"), std::string::npos) << said;
    EXPECT_NE(said.find("of 2 pictures"), std::string::npos) << said;
  }
  EXPECT_THROW(read("9"), std::runtime_error);
}

// The 348 bytes of a NIfTI-1 header whose sform turns the image a quarter about z, and its voxels.
TEST_F(LabelImages, ANiftiImageLiesWhereItsSformSays) {
  std::string bytes(352, '\0');
  const auto put = [&]<class T>(std::size_t at, T value) { std::memcpy(bytes.data() + at, &value, sizeof value); };
  put(0, std::int32_t{348});
  for (const auto& [at, value] : {std::pair{40, 3}, {42, 3}, {44, 2}, {46, 2}, {48, 1}, {50, 1}, {52, 1}, {54, 1}})
    put(at, static_cast<std::int16_t>(value));
  put(70, std::int16_t{2}), put(72, std::int16_t{8});
  for (const auto& [at, value] : {std::pair{76, 1.f}, {80, 1.f}, {84, 2.f}, {88, 3.f}, {108, 352.f}, {112, 1.f}})
    put(at, value);
  put(123, char{2}), put(254, std::int16_t{1});
  // x of the world is -2 j + 10, y is i + 20, z is 3 k + 30, all in millimetres and to the right and to the front.
  for (const auto& [at, value] : {std::pair{284, -2.f}, {292, 10.f}, {296, 1.f}, {308, 20.f}, {320, 3.f}, {324, 30.f}})
    put(at, value);
  bytes.replace(344, 4, std::string("n+1\0", 4));
  const LabelVolume turned = read_label_volume(write_file(folder_ / "t.nii", bytes + voxels_));
  // Voxel (2, 1, 1) lies at (8, 22, 33) there, which to the left and to the back is (-8, -22, 33).
  EXPECT_TRUE(place(turned, 11).isApprox(Eigen::Vector3d(-0.008, -0.022, 0.033))) << place(turned, 11).transpose();
  EXPECT_GT(turned.turn.determinant(), 0);
}

TEST_F(LabelImages, DamageIsRefused) {
  const auto refused = [&](const std::string& name, const std::string& bytes) {
    EXPECT_THROW(read_label_volume(write_file(folder_ / name, bytes)), std::runtime_error) << name;
  };
  const std::string good = mha("1");
  refused("cut.mha", good.substr(0, good.size() - 5));
  refused("huge.mha", replaced(good, "3 2 2", "60000 60000 60000"));
  refused("word.nii", "no image");
  refused("word.nrrd", "NRRD0004\ntype: uchar\n");
  EXPECT_THROW(read_label_volume(folder_.path()), std::runtime_error);
}

TEST_F(LabelImages, WhatIsSaidOfAFileHasNoAddressesInIt) {
  std::string said;
  try {
    read_label_volume(write_file(folder_ / "lacks.mha", replaced(mha("1"), "3 2 2", "3 2")));
  } catch (const std::runtime_error& error) {
    said = error.what();
  }
  EXPECT_NE(said.find("lacks.mha: ITK refuses it: "), std::string::npos) << said;
  EXPECT_EQ(said.find("0x"), std::string::npos) << said;
  EXPECT_EQ(said.find('\n'), std::string::npos) << said;
}

}  // namespace
}  // namespace palpate
