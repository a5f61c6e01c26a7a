#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include "common/models/hybrid/join_meshes.hpp"
#include "tests/dynamics/hybrid_bodies.hpp"

/// Partial connections, and what cannot be connected.
namespace palpate {
namespace {

using Eigen::Vector3d;
using namespace testing;

const Vector3d kAslant(1.5, -0.7, -9.81);

/// A fine block below and a coarse one on top of it, twice as coarse.
struct Stack {
  TetMesh fine = make_block({0, 0, 0}, {0.04, 0.04, 0.02}, {4, 4, 2});
  TetMesh coarse = make_block({0, 0, 0.02}, {0.04, 0.04, 0.06}, {2, 2, 2});
  HybridSpec body = hybrid_body({}, kAslant);

  Stack() {
    body.hybrid.regions.clear();
    body.hybrid.mesh = "coarse.msh";
    body.materials.clear();
    fix_below(1e-6);
  }
  void fix_below(double z) {
    body.fixed = {BoundaryCondition{}};
    body.fixed[0].where.box = Box{{-1, -1, -1}, {1, 1, z}};
  }
};

TEST(PartialConnection, JoinsTheNodesThatCoincide) {
  const Stack stack;
  const auto archive = precompute(stack.body, stack.fine, &stack.coarse);
  const auto& hybrid = *archive.condensed;
  ASSERT_EQ(hybrid.connection.size(), 9u);
  for (int node : hybrid.connection) EXPECT_NEAR(archive.surface.position[node].z(), 0.02, 1e-9);
  EXPECT_EQ(archive.tetrahedra.size(), stack.coarse.tetrahedra.size());
  EXPECT_EQ(archive.mesh_nodes, static_cast<int>(stack.fine.nodes.size() + stack.coarse.nodes.size()) - 9);
  EXPECT_TRUE(hybrid.interface.empty());  // no face of one is a face of the other
  EXPECT_EQ(hybrid.gap.size(), 16u);      // the fine interface nodes that are not shared
  EXPECT_NEAR(hybrid.max_gap, 0, 1e-12);
}

TEST(PartialConnection, NodesCoincideWithinATolerance) {
  Stack stack;
  for (auto& node : stack.coarse.nodes) node += Vector3d(5e-6, -5e-6, 5e-6);
  EXPECT_EQ(precompute(stack.body, stack.fine, &stack.coarse).condensed->connection.size(), 9u);
  for (auto& node : stack.coarse.nodes) node.x() += 1e-4;
  EXPECT_THROW(precompute(stack.body, stack.fine, &stack.coarse), std::runtime_error);
}

TEST(PartialConnection, ReportsTheGapBetweenTheSurfaces) {
  Stack stack;
  for (auto& node : stack.fine.nodes) {  // the nodes that are not shared lie lower
    const bool shared = std::lround(node.x() * 100) % 2 == 0 && std::lround(node.y() * 100) % 2 == 0;
    if (node.z() > 0.0199 && !shared) node.z() -= 7e-4;
  }
  const auto archive = precompute(stack.body, stack.fine, &stack.coarse);
  EXPECT_NEAR(archive.condensed->max_gap, 7e-4, 1e-5);
  stack.body.dynamic.gravity.setZero();
  const HybridRun<double> weightless(precompute(stack.body, stack.fine, &stack.coarse), 0, 60, Vector3d::Zero());
  EXPECT_NEAR(weightless.part.gap(weightless.model), archive.condensed->max_gap, 1e-12);
  HybridRun<double> run(archive, 0, 60, kAslant);
  run.run(1.0);
  const double opened = run.part.gap(run.model);
  std::printf("gap at rest %.3f mm, under gravity %.3f mm\n", 1e3 * archive.condensed->max_gap, 1e3 * opened);
  EXPECT_GT(opened, 0);
  EXPECT_LT(opened, 5e-3);
}

TEST(PartialConnection, FullConnectionHasNoGap) {
  Stack stack;
  stack.coarse = make_block({0, 0, 0.02}, {0.04, 0.04, 0.06}, {4, 4, 4});
  const auto archive = precompute(stack.body, stack.fine, &stack.coarse);
  EXPECT_EQ(archive.condensed->connection.size(), 25u);
  EXPECT_TRUE(archive.condensed->gap.empty());
  EXPECT_EQ(archive.condensed->interface.size(), 32u);
}

TEST(PartialConnection, RestsWhereTheJoinedMeshWould) {
  const Stack stack;
  const auto problem = make_static_problem(stack.body, join_meshes(stack.fine, stack.coarse, "test"));
  const auto direct = solve_loads(problem, weights(problem, kAslant));
  HybridRun<double> twice(precompute(stack.body, stack.fine, &stack.coarse), 0, 60, kAslant);
  twice.run(2);
  EXPECT_LT(static_difference(twice, direct), 1e-6);
  HybridRun<float> once(precompute(stack.body, stack.fine, &stack.coarse), 0, 60, kAslant);
  once.run(2);
  EXPECT_LT(static_difference(once, direct), 1e-3);
}

TEST(HybridInterface, FacesLieBetweenTheParts) {
  const auto mesh = make_hybrid_block({4, 3, 4}, 0.01);
  const auto archive = precompute(hybrid_body(random_part(mesh, 4)), mesh);
  const auto& hybrid = *archive.condensed;
  ASSERT_GT(hybrid.interface.size(), 10u);
  const auto& x = archive.surface.position;
  for (const auto& [a, b, c, facet] : hybrid.interface) {
    const auto& tet = archive.tetrahedra[facet / 4];
    const auto& face = kTetFaces[facet % 4];
    EXPECT_EQ((std::set{a, b, c}), (std::set{tet[face[0]], tet[face[1]], tet[face[2]]}));
    const Vector3d normal = (x[b] - x[a]).cross(x[c] - x[a]);
    EXPECT_GT(normal.dot(x[tet[facet % 4]] - x[a]), 0);  // out of the quasi-static part, into the other
  }
  for (std::size_t i = 0; i < archive.surface.triangles.size(); ++i) {
    bool only_dynamic = true, only_quasi_static = true;
    for (int node : archive.surface.triangles[i]) {
      const bool shared = std::ranges::binary_search(hybrid.connection, node);
      const bool moves =
          std::ranges::any_of(archive.tetrahedra, [&](const auto& t) { return std::ranges::find(t, node) != t.end(); });
      only_dynamic &= moves;
      only_quasi_static &= shared || !moves;
    }
    EXPECT_TRUE(static_cast<int>(i) < hybrid.quasi_static_triangles ? only_quasi_static : only_dynamic);
  }
}

std::string refusal(const HybridSpec& body, const TetMesh& mesh, const TetMesh* coarse = nullptr) {
  try {
    precompute(body, mesh, coarse);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(HybridRefusal, IsAPlainSentence) {
  const auto mesh = make_hybrid_block({4, 3, 4}, 0.01);
  auto body = hybrid_body({});
  body.hybrid.regions[0].box = Box{{-1, -1, -1}, {1, 1, 1}};
  EXPECT_EQ(refusal(body, mesh),
            "body 'organ': [body.hybrid] leaves no quasi-static part: the regions hold every element of the mesh");
  body.hybrid.regions[0].box = Box{{1, 1, 1}, {2, 2, 2}};
  EXPECT_EQ(refusal(body, mesh), "body 'organ': [[body.hybrid.region]] number 1 selects no element of the mesh");
  body.hybrid.regions[0].box = Box{{-1, -1, 0.02}, {1, 1, 1}};
  body.fixed.clear();
  EXPECT_EQ(refusal(body, mesh), "body 'organ': unfixed body: it has no [[body.fixed]] section");

  Stack stack;
  for (auto& node : stack.coarse.nodes) node.z() += 1;
  EXPECT_EQ(refusal(stack.body, stack.fine, &stack.coarse),
            "body 'organ': [body.hybrid]: no node of the tensor-mass mesh coincides with a surface node of "
            "the body's mesh");
}

/// Fixed nodes in the tensor-mass part alone: the quasi-static part stands on three connection nodes, not on
/// two.
TEST(HybridRefusal, OfAQuasiStaticPartThatWouldFloat) {
  for (const bool by_an_edge : {true, false}) {
    Stack stack;
    const double y = by_an_edge ? 0.04 : 0;
    stack.coarse = make_block({0, y, 0.02}, {0.04, y + 0.04, 0.06}, {2, 2, 2});
    stack.body.fixed[0].where.box = Box{{-1, -1, 0.059}, {1, 1, 1}};
    const auto sentence = refusal(stack.body, stack.fine, &stack.coarse);
    if (by_an_edge) {
      EXPECT_NE(sentence.find("[body.hybrid] leaves 192 quasi-static tetrahedra that would float"), std::string::npos)
          << sentence;
    } else {
      EXPECT_EQ(sentence, "");
      EXPECT_TRUE(precompute(stack.body, stack.fine, &stack.coarse).condensed->held_by_connection);
    }
  }
}

}  // namespace
}  // namespace palpate
