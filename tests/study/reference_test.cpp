#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "common/fem/linear_contact.hpp"
#include "common/fem/newton_solid.hpp"
#include "common/fem/refine_graded.hpp"
#include "common/mesh/generators.hpp"
#include "common/mesh/surface.hpp"
#include "tools/rig/example_bodies.hpp"

/// The solvers that the study's references come from.
namespace palpate::study {
namespace {

using Eigen::Vector3d;

SolidSpec soft_block(double poisson = 0.3) {
  return block_body<SolidSpec>({}, poisson);
}

/// 60 x 60 x 30 mm on its base, top at z = 30 mm.
StaticProblem block(int cells, double poisson = 0.3) {
  return make_static_problem(soft_block(poisson), middle_block_mesh(cells));
}

Eigen::Matrix<double, 4, 3> random_corners(unsigned seed, double size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  return Eigen::Matrix<double, 4, 3>::NullaryExpr([&] { return uniform(random); });
}

const TetGradients kTet =
    tet_gradients({Vector3d(0, 0, 0), Vector3d(1, 0.1, 0), Vector3d(0.2, 1.1, 0), Vector3d(0.1, 0.2, 0.9)});
const Lame kLame = lame({5000, 0.4, 1000});

TEST(NeoHookean, ForcesAreTheDerivativeOfTheEnergyAndTheTangentThatOfTheForces) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto u = random_corners(seed, 0.15);
    const ElementResponse r = element_response(Law::neo_hookean, kTet, kLame, u);
    EXPECT_LT((r.tangent - r.tangent.transpose()).norm(), 1e-12 * r.tangent.norm());
    const double h = 1e-6;
    for (int i = 0; i < 12; ++i) {
      auto more = u, less = u;
      more(i / 3, i % 3) += h;
      less(i / 3, i % 3) -= h;
      const double slope =
          (element_energy(Law::neo_hookean, kTet, kLame, more) - element_energy(Law::neo_hookean, kTet, kLame, less)) /
          (2 * h);
      EXPECT_NEAR(slope, r.gradient[i], 1e-6 * r.gradient.norm());
      const Eigen::Matrix<double, 12, 1> column = (element_response(Law::neo_hookean, kTet, kLame, more).gradient -
                                                   element_response(Law::neo_hookean, kTet, kLame, less).gradient) /
                                                  (2 * h);
      EXPECT_LT((column - r.tangent.col(i)).norm(), 1e-6 * r.tangent.norm());
    }
  }
}

TEST(NeoHookean, IsTheLinearElementForSmallDisplacements) {
  const auto u = random_corners(3, 1e-7);
  const ElementResponse linear = element_response(Law::linear, kTet, kLame, u),
                        neo = element_response(Law::neo_hookean, kTet, kLame, u);
  EXPECT_LT((linear.tangent - neo.tangent).norm(), 1e-5 * linear.tangent.norm());
  EXPECT_LT((linear.gradient - neo.gradient).norm(), 1e-5 * linear.gradient.norm());
}

TEST(NeoHookean, ARigidRotationGivesNoForceWhereTheLinearLawGivesMuch) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Matrix<double, 4, 3> x{{0, 0, 0}, {1, 0.1, 0}, {0.2, 1.1, 0}, {0.1, 0.2, 0.9}};
  const Eigen::Matrix<double, 4, 3> u = x * (turn - Eigen::Matrix3d::Identity()).transpose();
  const double linear = element_response(Law::linear, kTet, kLame, u).gradient.norm();
  EXPECT_LT(element_response(Law::neo_hookean, kTet, kLame, u).gradient.norm(), 1e-12 * linear);
}

TEST(NeoHookean, AnElementTurnedInsideOutHasInfiniteEnergy) {
  Eigen::Matrix<double, 4, 3> u = Eigen::Matrix<double, 4, 3>::Zero();
  u(3, 2) = -2;
  EXPECT_TRUE(std::isinf(element_energy(Law::neo_hookean, kTet, kLame, u)));
}

/// Axial force per area of a bar stretched by l with free sides: P = mu (l - 1/l) + lambda ln J / l, the
/// sides' stretch s from mu (s - 1/s) + lambda ln J / s = 0 with J = l s^2.
double uniaxial(const Lame& lame, double l) {
  double low = 0.2, high = 3;
  for (int i = 0; i < 200; ++i) {
    const double s = (low + high) / 2, side = lame.mu * (s * s - 1) + lame.lambda * std::log(l * s * s);
    (side > 0 ? high : low) = s;
  }
  const double j = l * low * low;
  return lame.mu * (l - 1 / l) + lame.lambda * std::log(j) / l;
}

TEST(NewtonSolid, ABarStretchedAndPressedWithFreeSidesFollowsTheClosedForm) {
  for (const double stretch : {0.6, 0.9, 1.3, 1.8}) {
    TetMesh mesh = make_block({0, 0, 0}, {0.01, 0.01, 0.02}, {2, 2, 3});
    DofMap dofs(mesh);
    for (int n = 0; n < static_cast<int>(mesh.nodes.size()); ++n)
      for (int axis = 0; axis < 3; ++axis)
        if (mesh.nodes[n][axis] == 0) dofs.fix(n, axis);
    std::vector<int> top;
    for (int n = 0; n < static_cast<int>(mesh.nodes.size()); ++n)
      if (mesh.nodes[n].z() > 0.02 - 1e-12) top.push_back(n), dofs.fix(n, 2);
    dofs.number();
    NewtonSolid solid({mesh, {{{5000, 0.4, 1000}}, {}}, dofs}, Law::neo_hookean);
    for (int i = 1; i <= 10; ++i) {
      for (const int n : top) solid.prescribe(n, 2, 0.02 * (stretch - 1) * i / 10);
      ASSERT_TRUE(solid.solve({}).converged) << "stretch " << stretch << ", step " << i;
    }
    double force = 0;
    const auto internal = solid.internal_force();
    for (const int n : top) force += internal[n].z();
    const double exact = uniaxial(lame({5000, 0.4, 1000}), stretch) * 1e-4;
    EXPECT_NEAR(force, exact, 1e-7 * std::abs(exact)) << "stretch " << stretch;
  }
}

TEST(NewtonSolid, ATinyPressIsThatOfTheLinearSolverAndADeepOneIsNot) {
  const StaticProblem problem = block(8);
  const double radius = 0.012;
  const auto ball = [&](double depth) { return Sphere{{0.001, 0.002, 0.03 + radius - depth}, radius}; };
  const LinearContact contact(problem, std::array{Vector3d(0, 0, 0.03)}, 0.012);
  const auto force = [&](Law law, double depth) {
    NewtonSolid solid(problem, law, 1e9);
    return -solid.press(ball(0), ball(depth)).force.z();
  };
  const double tiny = -contact.press(ball(4e-4)).force.z(), deep = -contact.press(ball(6e-3)).force.z();
  EXPECT_NEAR(force(Law::linear, 4e-4), tiny, 0.01 * tiny);
  EXPECT_NEAR(force(Law::neo_hookean, 4e-4), tiny, 0.05 * tiny);
  EXPECT_NEAR(force(Law::linear, 6e-3), deep, 0.01 * deep);
  EXPECT_GT(std::abs(force(Law::neo_hookean, 6e-3) / deep - 1), 0.05);
}

double volume(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.tetrahedra) {
    const auto& x = mesh.nodes;
    const double v = (x[t[1]] - x[t[0]]).dot((x[t[2]] - x[t[0]]).cross(x[t[3]] - x[t[0]])) / 6;
    EXPECT_GT(v, 0);
    sum += v;
  }
  return sum;
}

SizeField around(const Vector3d& centre, double radius, double inner, double growth, double outer) {
  return [=](const Vector3d& x) {
    return std::min(outer, size_around(x, centre, Vector3d::UnitZ(), radius, inner, growth));
  };
}

TEST(Graded, AFinerMeshIsConformingHasTheSameShapeAndKeepsItsNodes) {
  SolidSpec body = soft_block();
  body.materials.push_back(
      {.where = {.indices = {}, .box = Box{{-1, -1, 0.015}, {1, 1, 1}}, .group = {}}, .material = {9000, 0.2, 1000}});
  const StaticProblem coarse = make_static_problem(body, middle_block_mesh(4));
  const StaticProblem fine = refine_graded(coarse, around({0, 0, 0.03}, 0.008, 0.003, 0.5, 0.012), 100000);
  EXPECT_GT(fine.mesh.nodes.size(), 4 * coarse.mesh.nodes.size());
  for (std::size_t n = 0; n < coarse.mesh.nodes.size(); ++n) EXPECT_EQ(fine.mesh.nodes[n], coarse.mesh.nodes[n]);
  EXPECT_NEAR(volume(fine.mesh), volume(coarse.mesh), 1e-12 * volume(coarse.mesh));
  // Were a face not matched by its neighbour it would be part of the surface, whose area would then be
  // larger.
  const auto area = [](const TetMesh& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : extract_surface(mesh).triangles)
      sum += (mesh.nodes[b] - mesh.nodes[a]).cross(mesh.nodes[c] - mesh.nodes[a]).norm() / 2;
    return sum;
  };
  EXPECT_NEAR(area(fine.mesh), area(coarse.mesh), 1e-9 * area(coarse.mesh));
  for (std::size_t n = 0; n < fine.mesh.nodes.size(); ++n)
    EXPECT_EQ(fine.dofs.index(static_cast<int>(n), 0) == DofMap::kFixed, fine.mesh.nodes[n].z() < 1e-12);
  double largest = 0;
  for (const auto& t : fine.mesh.tetrahedra)
    for (int v = 0; v < 4; ++v)
      for (int w = 0; w < v; ++w) largest = std::max(largest, (fine.mesh.nodes[t[v]] - fine.mesh.nodes[t[w]]).norm());
  EXPECT_LE(largest, 0.012 + 1e-12);
  for (std::size_t e = 0; e < fine.mesh.tetrahedra.size(); ++e) {
    double z = 0;
    for (const int n : fine.mesh.tetrahedra[e]) z += fine.mesh.nodes[n].z() / 4;
    EXPECT_EQ(fine.materials.at(static_cast<int>(e)).young, z > 0.015 ? 9000 : 5000);
  }
}

TEST(LinearContact, AShallowPressOnALargeBlockComesToHertzAsTheMeshGetsFiner) {
  const double r = 0.05, e = 5000, nu = 0.3, d = 0.01 * r, a = std::sqrt(r * d);
  const double hertz = 4.0 / 3 * e / (1 - nu * nu) * std::sqrt(r) * std::pow(d, 1.5);
  const StaticProblem block =
      make_static_problem(soft_block(), make_block({-0.3, -0.3, 0}, {0.3, 0.3, 0.3}, {4, 4, 2}));
  double last = 1;
  for (const double share : {0.55, 0.36}) {  // of the contact's radius; the edges grow as slowly as they are small
    const double h = share * a;
    const StaticProblem fine = refine_graded(block, around({0, 0, 0.3}, a, h, share, 0.2), 100000);
    const LinearContact contact(fine, std::array{Vector3d(0, 0, 0.3)}, 1.3 * a);
    const PressState state = contact.press({{0.0003, 0.0002, 0.3 + r - d}, r});
    const double error = std::abs(-state.force.z() / hertz - 1);
    std::printf("h = a/%.1f: %zu nodes, force off by %.2f %%\n", a / h, fine.mesh.nodes.size(), 100 * error);
    EXPECT_LT(error, last);
    EXPECT_LT(std::hypot(state.force.x(), state.force.y()), 0.02 * hertz);
    last = error;
  }
  EXPECT_LT(last, 0.11);
}

TEST(LinearContact, QuadraticElementsComeNearerToHertzThanLinearOnesOnTheSameMesh) {
  const double r = 0.05, e = 5000, nu = 0.3, d = 0.01 * r, a = std::sqrt(r * d);
  const double hertz = 4.0 / 3 * e / (1 - nu * nu) * std::sqrt(r) * std::pow(d, 1.5);
  const StaticProblem block =
      make_static_problem(soft_block(), make_block({-0.3, -0.3, 0}, {0.3, 0.3, 0.3}, {4, 4, 2}));
  const StaticProblem fine = refine_graded(block, around({0, 0, 0.3}, a, 0.5 * a, 1, 0.2), 100000);
  const auto error = [&](FiniteElement element) {
    const LinearContact contact(fine, std::array{Vector3d(0, 0, 0.3)}, 1.3 * a, element);
    const PressState state = contact.press({{0.0003, 0.0002, 0.3 + r - d}, r});
    EXPECT_LT(std::hypot(state.force.x(), state.force.y()), 0.02 * hertz);
    return std::abs(-state.force.z() / hertz - 1);
  };
  const double quadratic = error(FiniteElement::p2);
  EXPECT_LT(quadratic, 0.05);
  EXPECT_GT(error(FiniteElement::p1), 3 * quadratic);
}

}  // namespace
}  // namespace palpate::study
