#include "tools/organ/voxel_pieces.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace palpate {
namespace {

/// Of voxels of a grid of 9 x 9 x 9, of which the inner 5 x 5 x 5 are looked at, from 0 to 4.
VoxelTopology topology(const std::function<bool(int, int, int)>& inside) {
  constexpr int kRim = 2, kInner = 5, kAll = kInner + 2 * kRim;
  const GridShape shape{{kAll, kAll, kAll}, Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()};
  std::vector<char> voxels(shape.size(), 0);
  for (int k = 0; k < kInner; ++k)
    for (int j = 0; j < kInner; ++j)
      for (int i = 0; i < kInner; ++i) voxels[shape.index(i + kRim, j + kRim, k + kRim)] = inside(i, j, k);
  return topology_of(shape, voxels);
}

TEST(VoxelPieces, ABodyWhoseVoxelsShareFacesHasOneTopology) {
  const auto expect_only = [](const VoxelTopology& voxels, const Topology& wanted) {
    EXPECT_EQ(voxels.apart, wanted);
    EXPECT_EQ(voxels.joined, wanted);
    EXPECT_TRUE(voxels.allows(wanted));
    EXPECT_FALSE(voxels.allows({wanted.surfaces, wanted.handles + 1}));
    EXPECT_FALSE(voxels.allows({wanted.surfaces + 1, wanted.handles}));
  };
  const auto in_core = [](int i, int j, int k) { return i % 4 != 0 && j % 4 != 0 && k % 4 != 0; };
  expect_only(topology([](int, int, int) { return true; }), {1, 0});
  expect_only(topology([&](int i, int j, int k) { return !in_core(i, j, k); }), {2, 0});
  expect_only(topology([](int i, int j, int) { return i != 2 || j != 2; }), {1, 1});
  expect_only(topology([](int i, int, int) { return i % 2 == 0; }), {3, 0});
}

TEST(VoxelPieces, VoxelsThatMeetInAnEdgeOrACornerAloneMayBeApartOrJoined) {
  // Five voxels square, an open ring of which two meet in an edge.
  const VoxelTopology ring = topology([](int i, int j, int k) {
    const bool rim = i % 4 == 0 || j % 4 == 0;
    return k == 2 && rim && (i > 0 || j > 0);
  });
  EXPECT_EQ(ring.apart, (Topology{1, 0}));
  EXPECT_EQ(ring.joined, (Topology{1, 1}));
  EXPECT_TRUE(ring.allows({1, 0}) && ring.allows({1, 1}));
  EXPECT_FALSE(ring.allows({1, 2}) || ring.allows({2, 0}));
  const VoxelTopology corner = topology([](int i, int j, int k) { return i == j && j == k && i < 2; });
  EXPECT_EQ(corner.apart, (Topology{2, 0}));
  EXPECT_EQ(corner.joined, (Topology{1, 0}));
  // A cavity that comes out through a corner.
  const VoxelTopology cavity =
      topology([](int i, int j, int k) { return (i + j + k > 0) && (i != 1 || j != 1 || k != 1); });
  EXPECT_EQ(cavity.apart, (Topology{1, 0}));
  EXPECT_EQ(cavity.joined, (Topology{2, 0}));
}

}  // namespace
}  // namespace palpate
