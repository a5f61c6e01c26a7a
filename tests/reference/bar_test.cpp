#include <gtest/gtest.h>

#include "tests/fem/meshes_for_tests.hpp"
#include "tests/reference/loads.hpp"

/// A bar on three planes of symmetry, pulled along z: linear fields, so that linear elements are exact.
namespace palpate {
namespace {

constexpr double kWidth = 0.02, kDepth = 0.03, kBarLength = 0.1, kBarYoung = 5000, kPull = 0.001;

struct Bar {
  TetMesh mesh = testing::make_jittered_block({kWidth, kDepth, kBarLength}, {3, 4, 8}, 0.15);
  QuasiStaticSpec body;

  explicit Bar(double poisson) {
    body = testing::make_body(kBarYoung, poisson);
    body.fixed = {testing::fix_group("x0", {true, false, false}), testing::fix_group("y0", {false, true, false}),
                  testing::fix_group("z0", {false, false, true})};
  }

  void expect_stretch(const std::vector<Eigen::Vector3d>& displacement) const {
    const double strain = kPull / kBarLength, nu = body.material.poisson;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      const Eigen::Vector3d expected = strain * mesh.nodes[i].cwiseProduct(Eigen::Vector3d(-nu, -nu, 1));
      EXPECT_LT((displacement[i] - expected).norm(), 1e-11 * kPull);
    }
  }
};

TEST(Bar, PulledByItsEndStretchesUniformly) {
  for (double poisson : {0.0, 0.3, 0.45}) {
    const Bar bar(poisson);
    std::vector<Constraint> pull;
    for (int node : bar.mesh.groups.at("top").nodes) pull.push_back(hold(node, 2, kPull));
    const auto solution = solve_direct(make_static_problem(bar.body, bar.mesh), pull);
    bar.expect_stretch(solution.displacement);
    double force = 0;
    for (int node : bar.mesh.groups.at("top").nodes) force += solution.force[node].z();
    EXPECT_NEAR(force, kBarYoung * kWidth * kDepth * kPull / kBarLength, 1e-11 * force);
  }
}

TEST(Bar, UniformTractionGivesTheSameAndItsReactionsBalance) {
  const Bar bar(0.3);
  const double traction = kBarYoung * kPull / kBarLength;
  const auto load = testing::traction_load(
      bar.mesh, [](const auto& x) { return x.z() > kBarLength * (1 - 1e-9); },
      [&](const auto& normal) -> Eigen::Vector3d { return traction * normal; });
  const auto solution = solve_loads(make_static_problem(bar.body, bar.mesh), load);
  bar.expect_stretch(solution.displacement);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), support = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < load.size(); ++i) {
    sum += solution.force[i];
    support += solution.force[i] - load[i];
  }
  const double total = traction * kWidth * kDepth;
  EXPECT_LT(sum.norm(), 1e-11 * total);
  EXPECT_NEAR(support.z(), -total, 1e-11 * total);
}

}  // namespace
}  // namespace palpate
