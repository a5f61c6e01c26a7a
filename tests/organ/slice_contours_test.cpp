#include "tools/organ/slice_contours.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tools/organ/active_contour.hpp"

namespace palpate {
namespace {

TEST(SliceContours, OutlinesOfAnyVoxelsFillThemAgain) {
  constexpr int kWidth = 23, kHeight = 17;
  std::mt19937 random(1);
  for (const unsigned share : {1, 3, 7}) {  // of 8
    std::vector<char> voxels(kWidth * kHeight), filled(kWidth * kHeight);
    for (char& v : voxels) v = random() % 8 < share;
    fill_contours(outlines_of(kWidth, kHeight, voxels.data()), kWidth, kHeight, filled.data());
    EXPECT_EQ(filled, voxels) << share;
  }
}

TEST(SliceContours, AHoleRunsTheOtherWayAndLevelsLieBetweenVoxels) {
  const auto ring = level_lines(41, 41, [](int i, int j) {
    const double r = std::hypot(i - 20, j - 20);
    return std::max(r - 15.3, 8.2 - r);
  });
  ASSERT_EQ(ring.size(), 2u);
  const auto [hole, outer] = std::minmax({signed_area(ring[0]), signed_area(ring[1])});
  EXPECT_NEAR(outer, std::numbers::pi * 15.3 * 15.3, 2);
  EXPECT_NEAR(hole, -std::numbers::pi * 8.2 * 8.2, 2);
}

TEST(SliceContours, PointsAreSpreadEvenlyOverTheSameLine) {
  const Contour square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  const Contour even = resampled(square, 1);
  ASSERT_EQ(even.size(), 40u);
  for (std::size_t n = 0; n < even.size(); ++n) EXPECT_NEAR((even[(n + 1) % 40] - even[n]).norm(), 1, 1e-9) << n;
}

TEST(ActiveContour, MovesToADiscsBorderAndSpansTheGapWhereThereIsNone) {
  ScalarGrid grey{{{64, 64, 1}, Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(1e-3)}, {}};
  for (int j = 0; j < 64; ++j)
    for (int i = 0; i < 64; ++i) {
      const double out = std::hypot(i - 30.4, j - 31.7) - 20;
      const bool open = i > 40 && std::abs(j - 31.7) < 4;  // towards a neighbour of the same grey
      grey.value.push_back(static_cast<float>(open ? 100 : 60 + 40 / (1 + std::exp(2 * out))));
    }
  Contour start;
  for (int n = 0; n < 100; ++n) {
    const double angle = 2 * std::numbers::pi * n / 100;
    start.emplace_back(31 + 18.5 * std::cos(angle), 31 + 18.5 * std::sin(angle));
  }
  const MovedContour moved = move_to_edges(start, grey, 0, {100, 0.5}, {});
  EXPECT_LT(moved.on_edge, 1);
  EXPECT_GT(moved.on_edge, 0.85);
  for (const Eigen::Vector2d& x : moved.line) {
    const bool in_gap = x.x() > 40 && std::abs(x.y() - 31.7) < 7;
    EXPECT_NEAR((x - Eigen::Vector2d(30.4, 31.7)).norm(), 20, in_gap ? 3.0 : 0.3) << x.transpose();
  }
}

}  // namespace
}  // namespace palpate
