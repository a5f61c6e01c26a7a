#include "tools/organ/label_volume.hpp"

#include <gtest/gtest.h>

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
          if (v.value[v.shape.index(i, j, k)] == label) return v.turn * v.shape.place(i, j, k) + v.shift;
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

}  // namespace
}  // namespace palpate
