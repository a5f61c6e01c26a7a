#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

#include "bench/shell_cases.hpp"
#include "tests/shell/irregular_shells.hpp"

/// What docs/verification.md says of shells beside the cases of bench_shell_cases.
namespace palpate {
namespace {

using testing::ShellMotion;

/// Largest error of the inner nodes' motions over the largest motion, in units of rounding, on three
/// irregular patches whose rim moves by `motion`.
double patch_error(ShellMotion (*motion)(const Eigen::Vector3d&)) {
  double worst = 0;
  for (unsigned seed : {1, 2, 3}) {
    const ShellMesh mesh = testing::irregular_patch(seed);
    const ShellDofs all = testing::all_free(mesh);
    const Eigen::VectorXd exact = testing::motion_vector(mesh, all, motion);
    ShellDofs inner = testing::all_free(mesh);
    Eigen::VectorXd held = Eigen::VectorXd::Zero(exact.size());
    for (int i = 0; i < all.size(); ++i) {
      const auto& x = mesh.nodes[all.dof(i) / 6];
      if (x.x() > 1e-9 && x.x() < 1.2 - 1e-9 && x.y() > 1e-9 && x.y() < 1 - 1e-9) continue;
      inner.fix(all.dof(i) / 6, all.dof(i) % 6);
      held[i] = exact[i];
    }
    inner.number();
    const Eigen::VectorXd force = testing::whole_stiffness(mesh, all) * held;
    Eigen::VectorXd load(inner.size()), expected(inner.size());
    for (int i = 0; i < inner.size(); ++i) {
      const int at = all.index(inner.dof(i) / 6, inner.dof(i) % 6);
      load[i] = -force[at];
      expected[i] = exact[at];
    }
    const auto stiffness = assemble_shell_stiffness(mesh, testing::kWall, Bending::discrete_kirchhoff, inner, "patch");
    Factorisation factor(stiffness);
    factor.factorise(stiffness);
    const double error = (factor.solve(load) - expected).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
    worst = std::max(worst, error / std::numeric_limits<double>::epsilon());
  }
  return worst;
}

ShellMotion stretched(const Eigen::Vector3d& x) {
  ShellMotion motion = ShellMotion::Zero();
  motion.head<2>() = 1e-3 * Eigen::Vector2d(x.x() + 0.5 * x.y(), 0.5 * x.x() + x.y());
  return motion;
}

ShellMotion bent(const Eigen::Vector3d& x) {
  const double u = x.x(), v = x.y();
  return 1e-3 * (ShellMotion() << 0, 0, 0.5 * (u * u + u * v + v * v), 0.5 * u + v, -u - 0.5 * v, 0).finished();
}

/// The fields are those of MacNeal and Harder's patch for membranes and plates.
TEST(PublishedShells, PatchesCarryConstantStrainAndCurvatureToRounding) {
  const double membrane = patch_error(stretched), bending = patch_error(bent);
  RecordProperty("patch_membrane", fmt::format("{:.2f}", membrane));
  RecordProperty("patch_bending", fmt::format("{:.2f}", bending));
  EXPECT_LT(membrane, 1e3);
  EXPECT_LT(bending, 1e4);
}

/// The hemisphere of MacNeal and Harder with a hole of 18 degrees round its pole: radius 10, t = 0.04, pulled
/// along x and pressed along y at its rim; a quarter of it. Target 0.0940.
bench::ShellCase pierced_hemisphere(int n) {
  const auto wall = [](double u, double v) -> Eigen::Vector3d {
    const double around = u * std::numbers::pi / 2, up = v * 72 * std::numbers::pi / 180;
    return 10 * Eigen::Vector3d(std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up));
  };
  bench::ShellCase shell(bench::shell_grid(n, n, wall, bench::Diagonals::alternating), {6.825e7, 0.3, 0, 0.04});
  shell.mirror([](auto& x) { return bench::near(x.x(), 0); }, 0);
  shell.mirror([](auto& x) { return bench::near(x.y(), 0); }, 1);
  shell.dofs.fix(0, 2);  // the loads balance: any node will do
  shell.load[0].x() = 1;
  shell.load[n].y() = -1;
  shell.watch(0, {1, 0, 0}, 0.0940);
  return shell;
}

TEST(PublishedShells, HemisphereWithAHoleComesToThePublishedDisplacement) {
  double last = 1;
  for (int n : {8, 16, 32, 64}) {
    if (n == 64 && !std::getenv("PALPATE_LONG_TESTS")) continue;
    auto shell = pierced_hemisphere(n);
    const auto answer = bench::solve(shell);
    RecordProperty(fmt::format("pierced_hemisphere_n{}", n), fmt::format("{:.8g} {}", answer.value, answer.size));
    const double error = std::abs(answer.value / shell.target - 1);
    EXPECT_LT(error, last) << n;
    last = error;
  }
  EXPECT_LT(last, 0.02);
}

}  // namespace
}  // namespace palpate
