#include "tools/organ/mesh_pieces.hpp"

#include <gtest/gtest.h>

#include "common/mesh/generators.hpp"

namespace palpate {
namespace {

/// A block of two parts, the second from `from` [m] along x on.
FilledSolid block_of_two(double from) {
  FilledSolid block{make_block({0, 0, 0}, {1, 1, 1}, {8, 8, 8}), {}};
  for (const auto& t : block.mesh.tetrahedra) {
    double middle = 0;
    for (const int n : t) middle += block.mesh.nodes[n].x() / 4;
    block.part.push_back(middle < from ? 1 : 2);
  }
  return block;
}

TEST(MeshPieces, ATetrahedronThatHangsOnItsPartByAnEdgeIsGivenToTheOneAroundIt) {
  const FilledSolid whole = block_of_two(0.5);
  FilledSolid strays = whole;
  ASSERT_EQ(whole.part.front(), 1);
  ASSERT_EQ(whole.part.back(), 2);
  strays.part.front() = 2, strays.part.back() = 1;
  EXPECT_EQ(pieces_of(part_of(strays, 1)).size(), 2u);
  give_stray_pieces_away(strays);
  EXPECT_EQ(strays.part, whole.part);
}

TEST(MeshPieces, APieceThatIsLargeOrTouchesNoOtherPartStays) {
  FilledSolid large = block_of_two(0.5);
  for (std::size_t t = 0; t < 12; ++t) large.part[t] = 2;
  const std::vector<int> before = large.part;
  ASSERT_GT(pieces_of(part_of(large, 2)).size(), 1u);
  give_stray_pieces_away(large);
  EXPECT_EQ(large.part.size(), before.size());
  FilledSolid alone{make_block({0, 0, 0}, {1, 1, 1}, {8, 8, 8}), {}};
  const TetMesh far = make_block({2, 2, 2}, {2.1, 2.1, 2.1}, {1, 1, 1});
  const int shift = static_cast<int>(alone.mesh.nodes.size());
  alone.mesh.nodes.insert(alone.mesh.nodes.end(), far.nodes.begin(), far.nodes.end());
  for (const auto& [a, b, c, d] : far.tetrahedra)
    alone.mesh.tetrahedra.push_back({a + shift, b + shift, c + shift, d + shift});
  alone.part.assign(alone.mesh.tetrahedra.size(), 1);
  give_stray_pieces_away(alone);
  EXPECT_EQ(pieces_of(part_of(alone, 1)).size(), 2u);
}

}  // namespace
}  // namespace palpate
