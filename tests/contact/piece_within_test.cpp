#include "common/geometry/piece_within.hpp"

#include <gtest/gtest.h>

#include <random>

namespace palpate {
namespace {

using Eigen::Vector2d;
using Corners = std::array<Vector2d, 3>;

TEST(PieceWithin, OfATriangleThatLiesWithinIsAllOfIt) {
  const Corners t{Vector2d(0.1, 0.1), Vector2d(0.5, 0.2), Vector2d(0.2, 0.6)};
  for (const Corners& c : {t, Corners{t[1], t[0], t[2]}}) {
    const PlanePiece piece = piece_within(c, {0.5, 0.5}, 0.5);
    EXPECT_NEAR(piece.area, 0.5 * (0.4 * 0.5 - 0.1 * 0.1), 1e-15);
    EXPECT_LT((piece.middle() - (t[0] + t[1] + t[2]) / 3).norm(), 1e-15);
  }
}

TEST(PieceWithin, OfATriangleAboutTheSquareIsTheSquare) {
  const PlanePiece piece = piece_within({Vector2d(-9, -9), Vector2d(9, -9), Vector2d(0, 20)}, {0.3, 0.2}, 0.1);
  EXPECT_NEAR(piece.area, 0.04, 1e-15);
  EXPECT_LT((piece.middle() - Vector2d(0.3, 0.2)).norm(), 1e-14);
}

TEST(PieceWithin, OfOneBesideOrWithoutAreaIsNothing) {
  EXPECT_EQ(piece_within({Vector2d(1, 0), Vector2d(2, 0), Vector2d(1, 1)}, {0, 0}, 0.5).area, 0);
  EXPECT_EQ(piece_within({Vector2d(-1, -1), Vector2d(1, 1), Vector2d(0, 0)}, {0, 0}, 0.5).area, 0);
}

// Cuts of a plane into two triangles share a square out between them, wherever they go through it.
TEST(PieceWithin, OfTrianglesThatFillASquareAddUp) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int k = 0; k < 1000; ++k) {
    const std::array<Vector2d, 4> far{Vector2d(-5, -5), Vector2d(5, -5), Vector2d(5, 5), Vector2d(-5, 5)};
    const Vector2d meet(place(random), place(random)), middle(place(random), place(random));
    PlanePiece sum;
    for (int v = 0; v < 4; ++v) sum += piece_within({far[v], far[(v + 1) % 4], meet}, middle, 0.3);
    ASSERT_NEAR(sum.area, 0.36, 1e-14);
    ASSERT_LT((sum.middle() - middle).norm(), 1e-13);
  }
}

}  // namespace
}  // namespace palpate
