#include <gtest/gtest.h>

#include "common/view/instrument.hpp"
#include "render_node/refine.hpp"
#include "tests/render/scenery.hpp"

namespace palpate {
namespace {

using namespace testing;

TEST(Refinement, NewVerticesLieOnTheBallThatTheCornersSpan) {
  Ball ball = make_ball(1.0f, 6);
  ball.normal = ball.position;  // exact normals
  for (auto& n : ball.normal) n.normalize();
  const Refinement refinement(ball.triangles, static_cast<int>(ball.position.size()), 2);
  EXPECT_EQ(refinement.triangles().size(), 16 * ball.triangles.size());
  const std::size_t coarse = ball.position.size();
  ball.position.resize(refinement.vertices());
  ball.normal.resize(refinement.vertices());
  refinement.apply(ball.position, ball.normal);
  for (std::size_t i = coarse; i < ball.position.size(); ++i) {
    EXPECT_NEAR(ball.position[i].norm(), 1, 0.008);  // the chords themselves lie at 0.97
    EXPECT_GT(ball.normal[i].dot(ball.position[i].normalized()), 0.999);
  }
}

TEST(Refinement, FlatStaysFlat) {
  const std::vector<std::array<int, 3>> square{{0, 1, 2}, {0, 2, 3}};
  const Refinement refinement(square, 4, 1);
  std::vector<Eigen::Vector3f> x{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, n(4, Eigen::Vector3f::UnitZ());
  ASSERT_EQ(refinement.vertices(), 9);  // four corners and five edges, the shared one once
  x.resize(9);
  n.resize(9);
  refinement.apply(x, n);
  for (int i = 4; i < 9; ++i) {
    EXPECT_EQ(x[i].z(), 0);
    EXPECT_EQ(n[i], Eigen::Vector3f::UnitZ());
  }
  std::vector<float> value{0, 2, 4, 6};
  value.resize(9);
  refinement.apply(value);
  EXPECT_EQ(value[4], 1);
}

TEST(Refinement, LevelsKeepToTheLimit) {
  EXPECT_EQ(refinement_levels(900, 16000), 2);
  EXPECT_EQ(refinement_levels(1600, 16000), 1);
  EXPECT_EQ(refinement_levels(5000, 16000), 0);
}

TEST(Instrument, ClosedTipIsTheBallThatTouches) {
  InstrumentView view;
  view.tip_radius = 0.004;
  view.shaft_radius = 0.0025;
  const InstrumentShape shape = make_instrument(view);
  double front = 0;
  for (const int jaw : {1, 2})
    for (const auto& p : shape.parts[jaw].position) {
      front = std::max<double>(front, p.z());
      if (p.z() >= 0) {
        EXPECT_LE(p.norm(), 0.004001f);
      } else {
        EXPECT_LE(std::hypot(p.x(), p.y()), 0.004001f);
      }
    }
  EXPECT_NEAR(front, 0.004, 1e-6);
}

TEST(Instrument, TrianglesLookOutwards) {
  const InstrumentShape shape = make_instrument({});
  for (const InstrumentPart& part : shape.parts)
    for (const auto& [a, b, c] : part.triangles) {
      const Eigen::Vector3f area = (part.position[b] - part.position[a]).cross(part.position[c] - part.position[a]);
      if (area.norm() < 1e-12f) continue;
      EXPECT_GT(area.dot(part.normal[a] + part.normal[b] + part.normal[c]), 0);
    }
}

TEST(Instrument, AScalpelIsABladeWithinTheBallThatTouches) {
  InstrumentView view;
  view.blade = true;
  const InstrumentShape shape = make_instrument(view);
  Eigen::Vector3f largest = Eigen::Vector3f::Zero();
  for (const auto& p : shape.parts[1].position) {
    largest = largest.cwiseMax(p);
    EXPECT_LE(p.head<2>().norm(), view.tip_radius);
  }
  EXPECT_NEAR(largest.z(), view.tip_radius, 1e-6);
  EXPECT_LT(largest.x(), 0.4 * largest.y());
  for (const InstrumentPart& part : shape.parts)
    for (const auto& [a, b, c] : part.triangles) {
      const Eigen::Vector3f area = (part.position[b] - part.position[a]).cross(part.position[c] - part.position[a]);
      if (area.norm() < 1e-12f) continue;
      EXPECT_GT(area.dot(part.normal[a] + part.normal[b] + part.normal[c]), 0);
    }
}

TEST(Instrument, JawsOpenAwayFromEachOther) {
  InstrumentView view;
  view.jaw_opening = 0.6;
  const InstrumentShape shape = make_instrument(view);
  const Eigen::Vector3d tip(0, 0, view.tip_radius);
  const double up = (part_pose(view, shape, 1) * tip).y(), down = (part_pose(view, shape, 2) * tip).y();
  EXPECT_GT(up, 0);
  EXPECT_DOUBLE_EQ(up, -down);
  const Eigen::Vector3d hinge(0, 0, -shape.hinge);
  EXPECT_TRUE((part_pose(view, shape, 1) * hinge).isApprox(hinge));
}

TEST(Refinement, ASharpEdgeStaysStraight) {
  // Two squares that meet at a right angle, with the normals that averaging gives.
  const std::vector<std::array<int, 3>> roof{{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  const std::vector<Eigen::Vector3f> rest{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, -1}, {1, 1, -1}};
  const Refinement refinement(roof, 6, 1, rest);
  std::vector<Eigen::Vector3f> x = rest, n(6, Eigen::Vector3f(1, 0, 1).normalized());
  x.resize(refinement.vertices());
  n.resize(refinement.vertices());
  refinement.apply(x, n);
  for (int i = 6; i < refinement.vertices(); ++i) EXPECT_TRUE(x[i].z() == 0 || x[i].x() == 1) << x[i].transpose();
}

}  // namespace
}  // namespace palpate
