#include "common/shell/boundary_conditions.hpp"

#include <gtest/gtest.h>

#include "common/mesh/shell_generators.hpp"
#include "common/mesh/shell_quality.hpp"
#include "common/models/catheter/check_duct.hpp"
#include "common/models/modal_shell/spec.hpp"

namespace palpate {
namespace {

std::string sentence_of(const auto& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

ShellBoundaryCondition region_of(std::vector<int> nodes, std::array<bool, 3> axes = {true, true, true},
                                 bool rotations = true) {
  ShellBoundaryCondition region;
  region.where.indices = std::move(nodes);
  region.axes = axes;
  region.rotations = rotations;
  return region;
}

ModalShellSpec duct_body(std::vector<ShellBoundaryCondition> fixed) {
  ModalShellSpec body;
  body.name = "duct";
  body.mesh = "/meshes/duct.msh";
  body.shell.thickness = 0.001;
  body.fixed = std::move(fixed);
  return body;
}

ShellBoundaryCondition group(const char* name) {
  ShellBoundaryCondition region;
  region.where.group = name;
  return region;
}

class ShellBoundaryConditions : public ::testing::Test {
 protected:
  std::string complaint(std::vector<ShellBoundaryCondition> fixed) const {
    return sentence_of([&] { apply_boundary_conditions(tube, duct_body(std::move(fixed)), "body 'duct'"); });
  }
  ShellMesh tube = make_tube(0.005, 0.06, 8, 6);
};

TEST_F(ShellBoundaryConditions, ClampedNodesLoseAllSixDofsAndHingedOnesThree) {
  const ShellDofs clamped = apply_boundary_conditions(tube, duct_body({group("end1")}), "x");
  EXPECT_EQ(clamped.size(), 6 * (56 - 8));
  EXPECT_EQ(clamped.translations(), 3 * (56 - 8));
  ShellBoundaryCondition hinge = group("end1");
  hinge.rotations = false;
  const ShellDofs hinged = apply_boundary_conditions(tube, duct_body({hinge}), "x");
  EXPECT_EQ(hinged.translations(), 3 * (56 - 8));
  EXPECT_EQ(hinged.size(), 6 * 56 - 3 * 8);
  EXPECT_EQ(hinged.index(48, 2), ShellDofs::kFixed);
  EXPECT_GE(hinged.index(48, 3), 0);
}

TEST_F(ShellBoundaryConditions, AxesAreThoseOfTheWorld) {
  const ShellDofs dofs =
      apply_boundary_conditions(tube, duct_body({group("end1"), region_of({3}, {false, true, false}, false)}), "x");
  EXPECT_GE(dofs.index(3, 0), 0);
  EXPECT_EQ(dofs.index(3, 1), ShellDofs::kFixed);
  EXPECT_GE(dofs.index(3, 2), 0);
  EXPECT_GE(dofs.index(3, 4), 0);
}

TEST_F(ShellBoundaryConditions, NodesThatNoTriangleUsesHaveNoDofs) {
  tube.nodes.push_back({0, 0, 0});
  const ShellDofs dofs = apply_boundary_conditions(tube, duct_body({group("end1")}), "x");
  EXPECT_EQ(dofs.index(56, 0), ShellDofs::kUnused);
  EXPECT_EQ(complaint({region_of({56})}),
            "body 'duct': [[body.fixed]] number 1: an empty fixed set: it selects no node of the mesh");
}

TEST_F(ShellBoundaryConditions, AClampedNodeHoldsAShellAndAHingedOneDoesNot) {
  EXPECT_EQ(complaint({region_of({5})}), "");
  EXPECT_EQ(complaint({region_of({5}, {true, true, true}, false)}),
            "body 'duct': unfixed body: the fixed nodes leave 3 rigid-body motions free, fix more nodes, "
            "axes or rotations");
  EXPECT_EQ(complaint({region_of({0, 4}, {true, true, true}, false)}),
            "body 'duct': unfixed body: the fixed nodes leave 1 rigid-body motion free, fix more nodes, axes "
            "or rotations");
  EXPECT_EQ(complaint({region_of({0, 2, 4}, {true, true, true}, false)}), "");
  EXPECT_EQ(complaint({region_of({0, 2, 4}, {false, false, true}, true)}),
            "body 'duct': unfixed body: the fixed nodes leave 2 rigid-body motions free, fix more nodes, "
            "axes or rotations");
}

TEST_F(ShellBoundaryConditions, WhatSelectsNothingIsRefused) {
  EXPECT_EQ(complaint({}), "body 'duct': unfixed body: it has no [[body.fixed]] section");
  EXPECT_EQ(complaint({group("end2")}),
            "body 'duct': [[body.fixed]] number 1: the mesh has no group 'end2' (it has end0, end1)");
  EXPECT_EQ(complaint({region_of({56})}),
            "body 'duct': [[body.fixed]] number 1: node 56 is not in the mesh, which has 56 (0 to 55)");
  std::vector<int> all(56);
  for (int n = 0; n < 56; ++n) all[n] = n;
  EXPECT_EQ(complaint({region_of(all)}), "body 'duct': every node is fixed, nothing is left to deform");
}

class ShellCheck : public ::testing::Test {
 protected:
  std::string complaint(const ShellMesh& mesh) const {
    return sentence_of([&] { check_shell(body, mesh, apply_boundary_conditions(mesh, body, "x"), "body 'duct'"); });
  }
  ShellMesh tube = make_tube(0.005, 0.06, 20, 12);
  ModalShellSpec body = duct_body({group("end1")});
};

TEST_F(ShellCheck, AWallThickerThanTheTubesRadiusIsRefused) {
  body.shell.thickness = 0.0049;
  EXPECT_EQ(complaint(tube), "");
  body.shell.thickness = 0.0051;
  EXPECT_EQ(complaint(tube),
            "body 'duct': the wall is 5.1 mm thick, and the radius of its middle surface is 4.938 mm: a thin "
            "wall is thinner than that");
}

TEST_F(ShellCheck, AWallThinnerThanATenThousandthOfItsEdgesIsRefused) {
  body.shell.thickness = 1e-6;
  EXPECT_EQ(complaint(tube), "");
  body.shell.thickness = 1e-7;
  const std::string sentence = complaint(tube);
  EXPECT_TRUE(sentence.starts_with("body 'duct': the wall is 0.0001 mm thick, ")) << sentence;
  EXPECT_NE(sentence.find("below 0.0001 its bending is lost in the rounding of its stretching"), std::string::npos);
}

TEST_F(ShellCheck, OfAShellThatIsNoTubeHalfItsExtentCounts) {
  ShellMesh cup = tube;
  const int bottom = static_cast<int>(cup.nodes.size());
  cup.nodes.push_back({0, 0, 0});
  for (int j = 0; j < 20; ++j) cup.triangles.push_back({bottom, (j + 1) % 20, j});
  check_shell_mesh(cup, "cup");
  body.shell.thickness = 0.0299;
  EXPECT_EQ(complaint(cup), "");
  body.shell.thickness = 0.0301;
  EXPECT_NE(complaint(cup).find("half extent of its middle surface is 30 mm"), std::string::npos) << complaint(cup);
}

TEST_F(ShellCheck, MoreModesThanFreeDisplacementsAreRefused) {
  body.shell.modes = 3 * 20 * 12;
  EXPECT_EQ(complaint(tube), "");
  body.shell.modes += 1;
  EXPECT_EQ(complaint(tube),
            "body 'duct': it asks for 721 modes, and its mesh has 720 free displacements: ask for fewer");
}

class DuctCheck : public ShellCheck {
 protected:
  DuctCheck() {
    wire.name = "wire";
    wire.catheter = Catheter{.inside = "duct", .radius = 0.00125};
  }
  std::string complaint(const ShellMesh& mesh) const {
    return sentence_of([&] { check_duct(wire, body, mesh); });
  }
  double& radius() { return wire.catheter.radius; }
  CatheterSpec wire;
};

TEST_F(DuctCheck, ATubeWiderThanTheCatheterPasses) {
  EXPECT_EQ(complaint(tube), "");
  radius() = 0.0044;
  EXPECT_EQ(complaint(tube), "");
}

TEST_F(DuctCheck, ACatheterWiderThanTheDuctIsRefused) {
  radius() = 0.0045;
  EXPECT_EQ(complaint(tube),
            "/meshes/duct.msh: the catheter 'wire' is 9 mm wide, and the duct 'duct' is 8.877 mm wide inside "
            "at its narrowest");
}

TEST_F(DuctCheck, AHoleInTheWallIsRefused) {
  ShellMesh holed = tube;
  holed.triangles.erase(holed.triangles.begin() + 100);
  EXPECT_EQ(complaint(holed),
            "/meshes/duct.msh: a tube with two open ends is expected, into which the catheter 'wire' is led, "
            "and the surface has 3 "
            "boundary lines: is there a hole in the wall?");
}

TEST_F(DuctCheck, AClosedEndIsRefused) {
  ShellMesh cup = tube;
  cup.nodes.push_back({0, 0, 0});
  for (int j = 0; j < 20; ++j) cup.triangles.push_back({static_cast<int>(cup.nodes.size()) - 1, (j + 1) % 20, j});
  EXPECT_NE(complaint(cup).find("and the surface has 1 boundary line"), std::string::npos) << complaint(cup);
}

}  // namespace
}  // namespace palpate
