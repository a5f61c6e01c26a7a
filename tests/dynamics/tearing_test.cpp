#include "common/dynamics/tearing.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include "tests/dynamics/model_checks.hpp"

namespace palpate::testing {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

const Corners kCorner{Vector3d(0, 0, 0), Vector3d(2, 0, 0), Vector3d(0, 3, 0), Vector3d(0, 0, 4)};

Corners moved(const Corners& rest, const Matrix3d& a, const Vector3d& shift = {0.5, -0.25, 1}) {
  Corners present;
  for (int c = 0; c < 4; ++c) present[c] = a * rest[c] + shift;
  return present;
}

TEST(Tearing, RigidMotionIsNoDeformation) {
  for (const double angle : {0.1, 0.5, 2.0, 3.1}) {
    const Corners present = moved(kCorner, rotation(angle, {1, -2, 0.5}));
    EXPECT_NEAR(volume_change(kCorner, present), 0, 1e-14);
    EXPECT_NEAR(mean_elongation(kCorner, present), 0, 1e-15);
    EXPECT_NEAR(max_elongation(kCorner, present), 0, 1e-15);
  }
}

TEST(Tearing, UniformGrowthChangesVolumeByItsCube) {
  for (const double s : {0.5, 0.9, 1.25, 2.0}) {
    const Corners present = moved(kCorner, s * rotation(0.7, {0, 1, 1}));
    EXPECT_NEAR(volume_change(kCorner, present), std::abs(s * s * s - 1), 1e-13);
    EXPECT_NEAR(mean_elongation(kCorner, present), s - 1, 1e-14);
    EXPECT_NEAR(max_elongation(kCorner, present), s - 1, 1e-14);
  }
}

TEST(Tearing, StretchAlongAnEdgeHasItsClosedForm) {
  const double s = 1.5;  // along x: edges 0-1, 1-2 and 1-3 grow, the others keep their length
  const Corners present = moved(kCorner, Vector3d(s, 1, 1).asDiagonal());
  const double along = s - 1, to_y = std::sqrt((4 * s * s + 9) / 13) - 1, to_z = std::sqrt((4 * s * s + 16) / 20) - 1;
  EXPECT_NEAR(volume_change(kCorner, present), s - 1, 1e-14);
  EXPECT_NEAR(mean_elongation(kCorner, present), (along + to_y + to_z) / 6, 1e-14);
  EXPECT_NEAR(max_elongation(kCorner, present), along, 1e-14);
}

TEST(Tearing, ShearKeepsTheVolumeAndLengthensAnEdge) {
  Matrix3d shear = Matrix3d::Identity();
  shear(0, 1) = 1;
  const Corners present = moved(kCorner, shear);
  EXPECT_NEAR(volume_change(kCorner, present), 0, 1e-14);
  EXPECT_NEAR(max_elongation(kCorner, present), std::sqrt(2.0) - 1, 1e-14);
}

TEST(Tearing, InvertedTetrahedronExceedsOne) {
  EXPECT_NEAR(volume_change(kCorner, moved(kCorner, Vector3d(-1, 1, 1).asDiagonal())), 2, 1e-14);
}

TEST(Tearing, WorstTetrahedraComeFirstAndTheDeadDoNot) {
  const ElasticMesh mesh = free_block({3, 3, 3});
  auto position = mesh.rest;
  const auto noise = random_field(position.size(), 1e-3, 9);
  for (std::size_t n = 0; n < position.size(); ++n) position[n] += noise[n];
  for (const auto criterion : {TearCriterion::volume, TearCriterion::mean_elongation, TearCriterion::max_elongation}) {
    const double threshold = 0.03;
    TearSearch search(mesh, criterion, threshold, 1000);
    const auto found = search.find(position);
    std::size_t above = 0;
    for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t)
      if (search.measure(t, position) > threshold) ++above;
    ASSERT_GT(above, 10u);
    ASSERT_LT(above, mesh.tetrahedra.size());
    ASSERT_EQ(found.size(), above);
    for (std::size_t i = 1; i < found.size(); ++i)
      ASSERT_GE(search.measure(found[i - 1], position), search.measure(found[i], position));

    const std::vector<int> all(found.begin(), found.end());
    TearSearch limited(mesh, criterion, threshold, 4);
    limited.remove(std::span(all).first(2));
    const auto few = limited.find(position);
    EXPECT_EQ(std::vector<int>(few.begin(), few.end()), std::vector<int>(all.begin() + 2, all.begin() + 6));
  }
}

TEST(Tearing, EquallyDeformedTetrahedraComeByNumber) {
  const ElasticMesh mesh = free_block({2, 2, 2});
  auto position = mesh.rest;
  for (auto& x : position) x *= 2;
  TearSearch search(mesh, TearCriterion::max_elongation, 0.5, 5);
  const auto found = search.find(position);
  EXPECT_EQ(std::vector<int>(found.begin(), found.end()), (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_TRUE(search.find(mesh.rest).empty());
}

TEST(Tearing, ThresholdsThatTearEverythingAreRefused) {
  const ElasticMesh mesh = free_block({1, 1, 1});
  for (const double threshold : {0.0, -0.1, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(TearSearch(mesh, TearCriterion::volume, threshold, 1), std::runtime_error);
  EXPECT_THROW(TearSearch(mesh, TearCriterion::volume, 0.1, 0), std::runtime_error);
}

}  // namespace
}  // namespace palpate::testing
