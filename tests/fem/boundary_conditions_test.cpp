#include "common/fem/boundary_conditions.hpp"

#include <gtest/gtest.h>

#include "tests/fem/meshes_for_tests.hpp"

namespace palpate {
namespace {

using testing::fix_group;
using testing::fix_nodes;

std::string refusal(const TetMesh& mesh, const std::vector<BoundaryCondition>& regions) {
  try {
    apply_boundary_conditions(mesh, regions, "body 'organ'");
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TetMesh cube() {
  return make_block({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
}

TEST(BoundaryConditions, EliminatesAxisByAxis) {
  const auto mesh = cube();
  const auto dofs =
      apply_boundary_conditions(mesh, {fix_group("bottom"), fix_group("x1", {true, false, false})}, "body");
  EXPECT_EQ(dofs.size(), 3 * 27 - 3 * 9 - 6);
  EXPECT_FALSE(dofs.is_free(0, 2));
  EXPECT_FALSE(dofs.is_free(26, 0));
  EXPECT_TRUE(dofs.is_free(26, 1));
  for (int i = 0; i < dofs.size(); ++i) EXPECT_EQ(dofs.index(dofs.dof(i) / 3, dofs.dof(i) % 3), i);
}

TEST(BoundaryConditions, RefusesABodyWithoutBoundaryConditions) {
  EXPECT_NE(refusal(cube(), {}).find("unfixed body"), std::string::npos);
}

TEST(BoundaryConditions, RefusesAnEmptySet) {
  BoundaryCondition nowhere;
  nowhere.where.box = Box{{5, 5, 5}, {6, 6, 6}};
  EXPECT_NE(refusal(cube(), {nowhere}).find("empty fixed set"), std::string::npos);
  EXPECT_NE(refusal(cube(), {fix_group("bottom", {false, false, false})}).find("empty fixed set"), std::string::npos);
}

TEST(BoundaryConditions, RefusesANodeOutOfRangeAndAnUnknownGroup) {
  EXPECT_NE(refusal(cube(), {fix_nodes({3, 27})}).find("node 27 is not in the mesh"), std::string::npos);
  EXPECT_NE(refusal(cube(), {fix_nodes({-1})}).find("node -1"), std::string::npos);
  EXPECT_NE(refusal(cube(), {fix_group("porta")}).find("no group 'porta'"), std::string::npos);
}

TEST(BoundaryConditions, CountsTheRigidMotionsThatRemain) {
  const auto mesh = cube();
  const auto remaining = [&](const std::vector<BoundaryCondition>& regions) {
    DofMap dofs(mesh);
    for (const auto& region : regions)
      for (int node : region.where.indices)
        for (int axis = 0; axis < 3; ++axis)
          if (region.axes[axis]) dofs.fix(node, axis);
    return remaining_rigid_motions(mesh, dofs);
  };
  EXPECT_EQ(remaining({fix_nodes({0})}), 3);                              // turns about the point
  EXPECT_EQ(remaining({fix_nodes({0, 1, 2})}), 1);                        // turns about the line
  EXPECT_EQ(remaining({fix_nodes({0, 2, 6})}), 0);                        // three points off a line
  EXPECT_EQ(remaining({fix_nodes({0, 2, 6}, {false, false, true})}), 3);  // slides on a table
}

TEST(BoundaryConditions, NamesTheRigidMotionsInItsRefusal) {
  const auto sentence = refusal(cube(), {fix_nodes({0, 1, 2})});
  EXPECT_NE(sentence.find("unfixed body"), std::string::npos);
  EXPECT_NE(sentence.find("1 rigid-body motion free"), std::string::npos);
}

TEST(BoundaryConditions, AcceptsThreePlanesOfSymmetry) {
  EXPECT_EQ(refusal(cube(), {fix_group("x0", {true, false, false}), fix_group("y0", {false, true, false}),
                             fix_group("z0", {false, false, true})}),
            "");
}

TEST(BoundaryConditions, GivesUnusedNodesNoDofs) {
  auto mesh = cube();
  mesh.nodes.push_back({9, 9, 9});
  const auto dofs = apply_boundary_conditions(mesh, {fix_group("bottom")}, "body");
  EXPECT_EQ(dofs.size(), 54);
  EXPECT_EQ(dofs.index(27, 0), DofMap::kUnused);
  EXPECT_NE(refusal(mesh, {fix_nodes({27})}).find("empty fixed set"), std::string::npos);
}

}  // namespace
}  // namespace palpate
