#include "common/sim/contact_stiffness.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kCompliance = 0.01;  // [m/N] of a node by itself

/// Nodes that do not move one another.
LocalStiffness::Answer apart(std::vector<int> nodes) {
  const auto rows = static_cast<Eigen::Index>(3 * nodes.size());
  return {std::move(nodes), kCompliance * Eigen::MatrixXd::Identity(rows, rows)};
}

TouchContact on(const Anchor& anchor, Touch touch, int tool = 0) {
  TouchContact c{.by = ToolPoint{.tool = tool}};
  c.touch = touch;
  c.anchor = anchor;
  c.normal = -Vector3d::UnitZ();
  return c;
}

TEST(ContactStiffness, IsThatOfTheAnchor) {
  const TouchContact c = on({{1, 2, 3}, {0.5, 0.25, 0.25}}, Touch::sticking);
  const double expected = 1 / (1.02 * kCompliance * (0.25 + 0.0625 + 0.0625));
  EXPECT_TRUE(contact_stiffness(apart({1, 2, 3}), std::array{c})[0].isApprox(expected * Matrix3d::Identity()));
}

TEST(ContactStiffness, OfWhatSlidesIsAlongTheNormalAlone) {
  const TouchContact c = on({{1, 1, 1}, Vector3d::UnitX()}, Touch::sliding);
  Matrix3d expected = Matrix3d::Zero();
  expected(2, 2) = 1 / (1.02 * kCompliance);
  EXPECT_TRUE(contact_stiffness(apart({1}), std::array{c})[0].isApprox(expected));
}

// The other two nodes carry nearly all of the contact: from the known one alone it would seem 2500 times as stiff.
TEST(ContactStiffness, IsNoneWhereANodeIsNotKnown) {
  const std::array contacts{on({{1, 2, 3}, {0.02, 0.5, 0.48}}, Touch::sticking),
                            on({{1, 1, 1}, Vector3d::UnitX()}, Touch::sticking)};
  const auto stiffness = contact_stiffness(apart({1}), contacts);
  EXPECT_TRUE(stiffness[0].isZero(0));
  EXPECT_TRUE(stiffness[1].isApprox(Matrix3d::Identity() / (1.02 * kCompliance)));
}

TEST(ContactStiffness, OfANodeThatAnAnchorDoesNotUseIsNotAsked) {
  const TouchContact c = on({{1, 2, 3}, {0, 0, 1}}, Touch::sticking);
  EXPECT_FALSE(contact_stiffness(apart({3}), std::array{c})[0].isZero(0));
}

TEST(ContactStiffness, OfOneToolIsNotThatOfAnother) {
  LocalStiffness::Answer answer = apart({1, 2});
  answer.compliance.block<3, 3>(0, 3) = answer.compliance.block<3, 3>(3, 0) = 0.5 * kCompliance * Matrix3d::Identity();
  const Anchor first{{1, 1, 1}, Vector3d::UnitX()}, second{{2, 2, 2}, Vector3d::UnitX()};
  const auto together = contact_stiffness(answer, std::array{on(first, Touch::sticking), on(second, Touch::sticking)});
  const auto by_two = contact_stiffness(answer, std::array{on(first, Touch::sticking), on(second, Touch::sticking, 1)});
  EXPECT_NEAR(together[0](0, 0), 1 / (1.52 * kCompliance), 1e-9 / kCompliance) << "both move as one";
  EXPECT_GT(by_two[0](0, 0), 1 / (1.02 * kCompliance)) << "the other tool holds its place";
}

}  // namespace
}  // namespace palpate
