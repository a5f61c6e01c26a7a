#include "common/contact/cut_surface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/contact/moving_surface.hpp"
#include "tests/mesh/cut_cases.hpp"
#include "tests/tool/count_allocations.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
constexpr double kBucket = 0.01;

/// A mesh that is cut while it moves: it sways as a whole, its nodes tremble, and now and then a node jumps.
struct MovingBody {
  explicit MovingBody(unsigned kind)
      : random(kind),
        mesh(cut_case(kind, random)),
        cut(mesh.tetrahedra, static_cast<int>(mesh.nodes.size())),
        surface(cut, mesh.nodes, kBucket),
        position(mesh.nodes) {}

  void step() {
    previous = position;
    const double sway = 0.004 * std::sin(0.2 * ++steps);
    for (std::size_t n = 0; n < position.size(); ++n) {
      position[n] = mesh.nodes[n] + Vector3d(sway, 0.3 * sway, -sway) + 0.0002 * anywhere();
      if (random() % 200 == 0) position[n] += 0.02 * anywhere();
    }
    surface.set_positions(position);
  }
  /// A step of a body that hardly moves.
  void tremble(double by) {
    previous = position;
    for (auto& x : position) x += by * anywhere();
    surface.set_positions(position);
  }
  void remove(int t) {
    cut.remove(t, removed);
    surface.follow();
  }

  Vector3d anywhere() {
    std::uniform_real_distribution<double> any(-1, 1);
    return {any(random), any(random), any(random)};
  }
  Triangle of(const std::vector<Vector3d>& x, int facet) const {
    const auto [a, b, c] = cut.facet(facet);
    return {x[a], x[b], x[c]};
  }
  std::vector<int> brute_force(const Vector3d& a, const Vector3d& b, double radius) const {
    std::vector<int> found;
    const Vector3d low = a.cwiseMin(b), high = a.cwiseMax(b);
    for (int t = 0; t < cut.size(); ++t)
      for (int id = 4 * t; id < 4 * t + 4; ++id) {
        if (!cut.is_visible(id)) continue;
        const auto box = swept_box(of(previous, id), of(position, id));
        if ((box[0] - high).cwiseMax(low - box[1]).cwiseMax(0.0).norm() <= radius) found.push_back(id);
      }
    return found;
  }
  void expect_found_as_by_brute_force() {
    const Vector3d a = 0.05 * anywhere(), b = a + 0.005 * anywhere();
    const double radius = std::pow(10.0, -4 + 2.5 * std::abs(anywhere().x()));
    const auto found = surface.find(a, b, radius);
    ASSERT_TRUE(std::ranges::equal(found, brute_force(a, b, radius))) << "step " << steps;
  }

  std::mt19937 random;
  TetMesh mesh;
  CutMesh cut;
  CutSurface surface;
  std::vector<Vector3d> position, previous = position;
  std::vector<int> removed;
  int steps = 0;
};

TEST(CutSurface, FindsWhatBruteForceFindsOnTheMovingAndCutSurface) {
  for (unsigned kind = 0; kind < 12; ++kind) {
    MovingBody body(kind);
    Cutter cutter(body.mesh, kind);
    while (body.cut.alive_count() > 0) {
      if (body.random() % 2 == 0)
        body.step();
      else
        body.tremble(body.random() % 2 == 0 ? 1e-6 : 1e-4);
      for (unsigned i = 0; i < body.random() % 3 && body.cut.alive_count() > 0; ++i) body.remove(cutter.aim(body.cut));
      for (int trial = 0; trial < 3; ++trial) body.expect_found_as_by_brute_force();
      if (::testing::Test::HasFatalFailure()) FAIL() << "kind " << kind;
    }
    EXPECT_TRUE(body.surface.find({0, 0, 0}, {0, 0, 0}, 10).empty());
    EXPECT_EQ(body.surface.buckets().overflow(), 0);
  }
}

TEST(CutSurface, AnswersAsALateComerThatErasesTheSameList) {
  MovingBody body(3);
  Cutter cutter(body.mesh, 1);
  for (int i = 0; i < 60; ++i) {
    body.step();
    body.remove(cutter.aim(body.cut));
  }
  CutMesh cut(body.mesh.tetrahedra, body.cut.nodes());
  CutSurface late(cut, body.mesh.nodes, kBucket);
  cut.erase(body.removed);
  late.follow();
  late.set_positions(body.surface.previous());
  late.set_positions(body.surface.positions());
  for (int trial = 0; trial < 300; ++trial) {
    const Vector3d a = 0.05 * body.anywhere(), b = 0.05 * body.anywhere();
    const auto expected = body.surface.find(a, b, 0.001);
    ASSERT_TRUE(std::ranges::equal(late.find(a, b, 0.001), expected));
  }
}

TEST(CutSurface, KnowsPresentAndPreviousCorners) {
  MovingBody body(0);
  body.step();
  body.step();
  for (int facet : body.cut.visible()) {
    EXPECT_EQ(body.surface.corners(facet), body.of(body.position, facet));
    EXPECT_EQ(body.surface.previous_corners(facet), body.of(body.previous, facet));
  }
}

TEST(CutSurface, HasNormalsThatPointOutAlsoIntoACut) {
  const TetMesh mesh = make_block({-1, -1, -1}, {1, 1, 1}, {6, 6, 6});
  CutMesh cut(mesh.tetrahedra, static_cast<int>(mesh.nodes.size()));
  CutSurface surface(cut, mesh.nodes, 0.3);
  std::vector<int> removed;
  for (int t = 0; t < cut.size(); ++t) {  // a shaft down to the middle
    Vector3d middle = Vector3d::Zero();
    for (int n : mesh.tetrahedra[t]) middle += 0.25 * mesh.nodes[n];
    if (middle.head<2>().cwiseAbs().maxCoeff() > 0.35 || middle.z() < 0) continue;
    cut.remove(t, removed);
    surface.follow();
  }
  for (int facet : cut.visible()) {
    const Triangle c = surface.corners(facet);
    const Vector3d n = surface.triangle_normal(facet).normalized(),
                   inner = mesh.nodes[cut.tetrahedron(facet / 4)[facet % 4]];
    EXPECT_NEAR(n.norm(), 1, 1e-12);
    EXPECT_LT(n.dot(inner - c[0]), 0);
  }
  for (int node = 0; node < cut.nodes(); ++node) {
    Vector3d sum = Vector3d::Zero();
    bool seen = false;
    for (int facet : cut.visible()) {
      const auto nodes = cut.facet(facet);
      if (std::ranges::find(nodes, node) == nodes.end()) continue;
      const Triangle c = surface.corners(facet);
      sum += (c[1] - c[0]).cross(c[2] - c[0]);
      seen = true;
    }
    EXPECT_EQ(surface.on_surface(node), seen);
    EXPECT_NEAR((surface.vertex_normal(node) - sum.normalized()).norm(), 0, 1e-12);
  }
  const int middle = (3 * 7 + 3) * 7 + 3;  // at the bottom of the shaft
  EXPECT_NEAR((surface.vertex_normal(middle) - Vector3d::UnitZ()).norm(), 0, 1e-9);
}

TEST(CutSurface, FollowsAPartThatFallsOutOfTheGrid) {
  MovingBody body(0);
  for (int i = 0; i < 200; ++i) {
    body.previous = body.position;
    for (auto& x : body.position) x.z() -= 0.01;
    body.surface.set_positions(body.position);
    const Vector3d at = body.position[0];
    ASSERT_TRUE(std::ranges::equal(body.surface.find(at, at, 0.003), body.brute_force(at, at, 0.003)));
    ASSERT_FALSE(body.surface.find(at, at, 0.003).empty());
  }
}

TEST(CutSurface, TakesNoMemoryAfterConstruction) {
  MovingBody body(3);
  Cutter cutter(body.mesh, 1);
  body.removed.reserve(body.mesh.tetrahedra.size());
  const long before = allocations();
  std::size_t found = 0;
  while (body.cut.alive_count() > 0) {
    body.step();  // assigns its own vectors in place
    body.remove(cutter.aim(body.cut));
    found += body.surface.find({0, 0, 0}, {0.02, 0.02, 0.02}, 0.1).size();
  }
  EXPECT_EQ(allocations() - before, 0);
  EXPECT_GT(found, 1000u);
}

}  // namespace
}  // namespace palpate
