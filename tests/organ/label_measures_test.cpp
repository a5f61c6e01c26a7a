#include "tools/organ/label_measures.hpp"

#include <gtest/gtest.h>

#include "common/mesh/generators.hpp"

namespace palpate {
namespace {

/// What is told of a cube of voxels and a block that is larger by so much.
std::string told_of_block(double larger) {
  constexpr double kVoxel = 1e-3;
  constexpr int kRim = 4, kSide = 8, kAll = kSide + 2 * kRim;  // voxels
  LabelVoxels voxels{{{kAll, kAll, kAll}, Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(kVoxel)},
                     {{1, "cube"}},
                     {std::vector<char>(kAll * kAll * kAll, 0)}};
  const auto within = [=](int n) { return n >= kRim && n < kRim + kSide; };
  for (int k = 0; k < kAll; ++k)
    for (int j = 0; j < kAll; ++j)
      for (int i = 0; i < kAll; ++i)
        voxels.inside[0][voxels.shape.index(i, j, k)] = within(i) && within(j) && within(k);
  const double side = kSide * kVoxel;
  const Eigen::Vector3d low = Eigen::Vector3d::Constant((kRim - 0.5) * kVoxel);
  FilledSolid filled{make_block(low, low + side * Eigen::Vector3d(1, 1, 1 + larger), {3, 3, 3}), {}};
  filled.part.assign(filled.mesh.tetrahedra.size(), 1);
  LabelSolid solid;
  solid.volumes = {side * side * side};
  Output out(false);
  out.next_mesh();
  ::testing::internal::CaptureStdout();
  tell_label_measures(voxels, {0}, solid, filled, out);
  return ::testing::internal::GetCapturedStdout();
}

TEST(LabelMeasures, AVolumeThatIsOffIsWarnedOf) {
  const std::string right = told_of_block(0.005), off = told_of_block(-0.12);
  EXPECT_NE(right.find("(+0.50 %)"), std::string::npos) << right;
  EXPECT_EQ(right.find("warning:"), std::string::npos) << right;
  EXPECT_NE(off.find("warning: the volume of 'cube' is 12 % less than that of its voxels"), std::string::npos) << off;
}

}  // namespace
}  // namespace palpate
