#include <gtest/gtest.h>

#include "common/fem/fine_problem.hpp"
#include "common/fem/hat_tractions.hpp"
#include "common/fem/nodal_patches.hpp"
#include "tests/fem/meshes_for_tests.hpp"
#include "tests/reference/loads.hpp"

/// What elements whose strain is averaged at their nodes say of bodies at rest, beside quadratic elements and the
/// linear ones that they are made of.
namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

StaticProblem averaged(StaticProblem problem) {
  problem.materials.nodal_strain.assign(problem.mesh.tetrahedra.size(), 1);
  return problem;
}

/// The faces move by a linear field, the inner nodes follow it.
TEST(AveragedStrain, PassesThePatchTestUpToIncompressibility) {
  Matrix3d gradient;
  gradient << 2, 1, 1, 3, -4, 1, 0, 1, 2;
  for (const double poisson : {0.0, 0.25, 0.49, 0.4999}) {
    auto body = testing::make_body(1e6, poisson);
    const auto mesh = testing::make_jittered_block({1, 1, 1}, {4, 4, 4}, 0.2);
    const auto problem = averaged(make_static_problem(body, mesh));
    StaticProblem free = problem;
    free.dofs = DofMap(free.mesh);
    free.dofs.number();
    std::vector<Constraint> held;
    for (int n = 0; n < static_cast<int>(mesh.nodes.size()); ++n) {
      const Vector3d& x = mesh.nodes[n];
      if (x.minCoeff() < 1e-9 || x.maxCoeff() > 1 - 1e-9)
        for (int axis = 0; axis < 3; ++axis) held.push_back(hold(n, axis, 1e-3 * gradient.row(axis).dot(x)));
    }
    const StaticSolution found = solve_direct(free, held);
    double worst = 0;
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
      worst = std::max(worst, (found.displacement[n] - 1e-3 * gradient * mesh.nodes[n]).norm());
    EXPECT_LT(worst, 1e-14 / (1 - 2 * poisson)) << poisson;
  }
}

/// Work of a load over its resultant, of this element and of linear ones over that of quadratic ones on `reference`.
struct Softness {
  double averaged, linear;
};

template <class Pressure>
Softness softness(const SolidSpec& body, const TetMesh& mesh, const TetMesh& reference, const Pressure& pressure) {
  const Traction traction = [&](const Vector3d& x, const Vector3d&) { return pressure(x); };
  const auto worked = [&](const TetMesh& of, const Offline& offline, bool average) {
    FineProblem fine = make_fine_problem(body, of, offline);
    const auto load = traction_loads(fine.space, traction);
    if (offline.element == FiniteElement::p2) return testing::work(load, solve_fine_loads(fine, load));
    const auto problem = make_static_problem(body, of);
    return testing::work(load, solve_loads(average ? averaged(problem) : problem, load).displacement);
  };
  const double exact = worked(reference, {0, FiniteElement::p2, Formulation::displacement}, false);
  const Offline linear{0, FiniteElement::p1, Formulation::displacement};
  return {worked(mesh, linear, true) / exact, worked(mesh, linear, false) / exact};
}

/// A square beam clamped at one end, pushed down at the other; of unit section and five long.
Softness cantilever(double poisson, int cells, double jitter) {
  auto body = testing::make_body(1000, poisson);
  body.fixed = {testing::fix_group("x0")};
  const Vector3d size(5, 1, 1);
  return softness(body, testing::make_jittered_block(size, {5 * cells, cells, cells}, jitter),
                  make_block({0, 0, 0}, size, {20, 4, 4}),
                  [](const Vector3d& x) { return x.x() > 5 - 1e-9 ? Vector3d(0, 0, -1) : Vector3d(0, 0, 0); });
}

/// A unit block in a box with a bonded floor and smooth walls, pressed on one quarter of its top.
Softness confined(double poisson, int cells, double jitter) {
  auto body = testing::make_body(1000, poisson);
  body.fixed = {testing::fix_group("z0"), testing::fix_group("x0", {true, false, false}),
                testing::fix_group("x1", {true, false, false}), testing::fix_group("y0", {false, true, false}),
                testing::fix_group("y1", {false, true, false})};
  const auto pressure = [](const Vector3d& x) -> Vector3d {
    const double px = std::max(0.0, 1 - 2 * x.x()), py = std::max(0.0, 1 - 2 * x.y());
    return x.z() > 1 - 1e-9 ? Vector3d(0, 0, -px * py) : Vector3d(0, 0, 0);
  };
  return softness(body, testing::make_jittered_block({1, 1, 1}, {cells, cells, cells}, jitter),
                  make_block({0, 0, 0}, {1, 1, 1}, {6, 6, 6}), pressure);
}

/// Within five hundredths up to nu = 0.49 with two cells across, where linear elements lack four tenths.
TEST(AveragedStrain, BendsAsQuadraticElementsDoOnCoarseMeshes) {
  for (const double poisson : {0.3, 0.49, 0.499})
    for (const double jitter : {0.0, 0.15})
      for (const int cells : {2, 3, 4}) {
        const Softness found = cantilever(poisson, cells, jitter);
        std::printf("cantilever nu %.3f, %d cells, jitter %.2f: averaged %+.1f %%, linear %+.1f %%\n", poisson, cells,
                    jitter, 100 * (found.averaged - 1), 100 * (found.linear - 1));
        EXPECT_NEAR(found.averaged, 1, poisson < 0.495 ? 0.05 : 0.07);
        EXPECT_LT(found.linear, cells == 4 ? 0.87 : cells == 3 ? 0.78 : 0.63) << "linear elements lock";
      }
}

TEST(AveragedStrain, IsCompressedInABoxAsQuadraticElementsAre) {
  for (const double poisson : {0.3, 0.49, 0.499})
    for (const double jitter : {0.0, 0.15})
      for (const int cells : {4, 8}) {
        const Softness found = confined(poisson, cells, jitter);
        std::printf("confined nu %.3f, %d cells, jitter %.2f: averaged %+.1f %%, linear %+.1f %%\n", poisson, cells,
                    jitter, 100 * (found.averaged - 1), 100 * (found.linear - 1));
        EXPECT_NEAR(found.averaged, 1, 0.05);
        EXPECT_LT(found.linear, found.averaged) << "linear elements are stiffer";
      }
}

}  // namespace
}  // namespace palpate
