#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "common/fem/fine_problem.hpp"
#include "common/fem/hat_tractions.hpp"
#include "common/mesh/generators.hpp"

/// Published cases of solids, each as one number over a mesh of n divisions and a discretisation.
namespace palpate::bench {

using Eigen::Vector3d;

struct SolidAnswer {
  double value;
  int unknowns;
};

inline BoundaryCondition hold_face(const char* group, std::array<bool, 3> axes = {true, true, true}) {
  BoundaryCondition region;
  region.where.group = group;
  region.axes = axes;
  return region;
}

/// A case before it is solved. Where `at` is empty the answer is the work of the load over its resultant: the mean
/// displacement along it.
struct SolidCase {
  TetMesh mesh;
  Material material;
  std::vector<BoundaryCondition> fixed;
  Traction traction;
  double resultant = 1;
};

struct SolidState {
  FineProblem problem;
  std::vector<Vector3d> displacement;
  double work;
};

inline SolidState solve_case(const SolidCase& solid, const Offline& offline) {
  SolidSpec body;
  body.name = "solid";
  body.material = solid.material;
  body.fixed = solid.fixed;
  auto problem = make_fine_problem(body, solid.mesh, offline);
  const auto load = traction_loads(problem.space, solid.traction);
  auto displacement = solve_fine_loads(problem, load);
  double work = 0;
  for (std::size_t i = 0; i < load.size(); ++i) work += load[i].dot(displacement[i]);
  return {std::move(problem), std::move(displacement), work};
}

inline SolidAnswer mean_along_load(const SolidCase& solid, const Offline& offline) {
  const auto state = solve_case(solid, offline);
  return {state.work / solid.resultant, state.problem.dofs.size()};
}

/// The traction of a resultant over the face that `on` accepts, whose area is given.
template <class On>
Traction on_face(On on, const Vector3d& force, double area) {
  return
      [=](const Vector3d& x, const Vector3d&) -> Vector3d { return on(x) ? Vector3d(force / area) : Vector3d::Zero(); };
}

/// MacNeal and Harder's straight cantilever 6 x 0.2 x 0.1, E = 1e7, nu = 0.3, unit end load along axis 0, 1 or 2.
/// Targets 3.0e-5, 0.1081, 0.4321. n elements over the width and the height, 15 n along.
inline SolidAnswer straight_beam(int n, const Offline& offline, int axis) {
  SolidCase beam{make_block(Vector3d::Zero(), {6, 0.2, 0.1}, {15 * n, n, n}), {1e7, 0.3, 1}, {hold_face("x0")}, {}, 1};
  beam.traction = on_face([](const Vector3d& x) { return x.x() > 6 - 1e-9; }, Vector3d::Unit(axis), 0.02);
  return mean_along_load(beam, offline);
}

/// Its rotation [rad] by Saint-Venant under a unit torque at the end: L / (G J).
inline double twist_target() {
  double sum = 0;
  for (int k = 1; k < 40; k += 2) sum += std::tanh(k * std::numbers::pi) / std::pow(k, 5);  // the section is 2 : 1
  const double torsion = 0.2 * 1e-3 / 3 * (1 - 96 / std::pow(std::numbers::pi, 5) * sum);
  return 6 * 2 * 1.3 / (1e7 * torsion);
}

/// The same beam under a unit torque, spread over its end in proportion to the distance from the axis: mean rotation
/// there, conjugate to the torque. Target 0.03411; the source prints 0.03208.
inline SolidAnswer straight_beam_twist(int n, const Offline& offline) {
  SolidCase beam{make_block(Vector3d::Zero(), {6, 0.2, 0.1}, {15 * n, n, n}), {1e7, 0.3, 1}, {hold_face("x0")}, {}, 1};
  static constexpr double kPolar = 0.02 * (0.04 + 0.01) / 12;
  beam.traction = [](const Vector3d& x, const Vector3d&) -> Vector3d {
    return x.x() > 6 - 1e-9 ? Vector3d(0, (0.05 - x.z()) / kPolar, (x.y() - 0.1) / kPolar) : Vector3d(Vector3d::Zero());
  };
  return mean_along_load(beam, offline);
}

/// Their curved beam: radii 4.12 and 4.32, a quarter circle, 0.1 thick, E = 1e7, nu = 0.25, unit end load along the
/// radius or across the plane. Targets 0.08734 and 0.5022.
inline SolidAnswer curved_beam(int n, const Offline& offline, bool in_plane) {
  constexpr double inner = 4.12, outer = 4.32, quarter = std::numbers::pi / 2;
  SolidCase beam{
      make_block({inner, 0, 0}, {outer, quarter, 0.1}, {n, 15 * n, n}), {1e7, 0.25, 1}, {hold_face("y0")}, {}, 1};
  for (auto& x : beam.mesh.nodes) x = {x.x() * std::cos(x.y()), x.x() * std::sin(x.y()), x.z()};
  const Vector3d force = in_plane ? Vector3d(Vector3d::UnitY()) : Vector3d(Vector3d::UnitZ());
  beam.traction = on_face([](const Vector3d& x) { return x.x() < 1e-9; }, force, 0.02);
  return mean_along_load(beam, offline);
}

/// Cook's membrane as a solid, 1 thick, the half above its middle plane: E = 1, nu = 1/3, unit shear on the right edge,
/// the left edge clamped in the plane. The deflection of the right edge's middle; target 23.96.
inline SolidAnswer cooks_membrane(int n, const Offline& offline) {
  SolidCase solid{make_block({0, 0, 0}, {1, 1, 0.5}, {n, n, 1}),
                  {1, 1. / 3, 1},
                  {hold_face("x0", {true, true, false}), hold_face("z0", {false, false, true})},
                  {},
                  1};
  for (auto& x : solid.mesh.nodes) x = {48 * x.x(), 44 * x.x() + x.y() * (44 - 28 * x.x()), x.z()};
  solid.traction = on_face([](const Vector3d& x) { return x.x() > 48 - 1e-9; }, Vector3d(0, 1, 0), 16);
  const auto state = solve_case(solid, offline);
  return {state.displacement[n / 2 * (n + 1) + n].y(), state.problem.dofs.size()};
}

inline double thick_cylinder_target(double poisson) {
  return (1 + poisson) * 9 / (1000.0 * 72) * ((1 - 2 * poisson) * 3 + 27);
}

/// A quarter of a cylinder of radii 3 and 9 in plane strain, E = 1000, unit pressure inside: mean radial displacement
/// there. Targets 5.0399e-3, 5.0602e-3 and 5.0623e-3 for nu = 0.49, 0.499 and 0.4999.
inline SolidAnswer thick_cylinder(int n, const Offline& offline, double poisson) {
  constexpr double quarter = std::numbers::pi / 2;
  SolidCase solid{make_block({3, 0, 0}, {9, quarter, 1}, {n, n, 1}),
                  {1000, poisson, 1},
                  {hold_face("y0", {false, true, false}), hold_face("y1", {true, false, false}),
                   hold_face("z0", {false, false, true}), hold_face("z1", {false, false, true})},
                  {},
                  3 * quarter};
  for (auto& x : solid.mesh.nodes) x = {x.x() * std::cos(x.y()), x.x() * std::sin(x.y()), x.z()};
  const double across = std::cos(0.5 * quarter / n);  // chords of the inner circle lie this much nearer to the axis
  solid.traction = [=](const Vector3d& x, const Vector3d& normal) -> Vector3d {
    const bool inside = x.head<2>().norm() < 3 * (1 + 1e-9) && x.head<2>().norm() > 3 * across - 1e-9 &&
                        std::abs(normal.z()) < 0.5 && normal.head<2>().dot(x.head<2>()) < -2;
    return inside ? Vector3d(-normal) : Vector3d::Zero();
  };
  return mean_along_load(solid, offline);
}

/// NAFEMS LE10, a thick elliptic plate under pressure: sigma_yy [Pa] at (2, 0, 0.6), the mean over the elements there.
/// Target -5.38e6. n elements along the radius, 2 n along the angle, n (even) through the thickness.
inline SolidAnswer nafems_le10(int n, const Offline& offline) {
  constexpr double quarter = std::numbers::pi / 2;
  SolidCase solid{make_block({0, 0, 0}, {1, quarter, 0.6}, {n, 2 * n, n}),
                  {210e9, 0.3, 1},
                  {hold_face("y0", {false, true, false}), hold_face("y1", {true, false, false}),
                   hold_face("x1", {true, true, false})},
                  {},
                  1};
  BoundaryCondition edge;
  edge.axes = {false, false, true};
  for (int i = 0; i < static_cast<int>(solid.mesh.nodes.size()); ++i) {
    auto& x = solid.mesh.nodes[i];
    if (x.x() > 1 - 1e-9 && std::abs(x.z() - 0.3) < 1e-9) edge.where.indices.push_back(i);
    const double a = 2 + 1.25 * x.x(), b = 1 + 1.75 * x.x();
    x = {a * std::cos(x.y()), b * std::sin(x.y()), x.z()};
  }
  solid.fixed.push_back(edge);
  solid.traction = [](const Vector3d& x, const Vector3d& normal) -> Vector3d {
    return x.z() > 0.6 - 1e-9 && normal.z() > 0.5 ? Vector3d(0, 0, -1e6) : Vector3d::Zero();
  };
  const auto state = solve_case(solid, offline);
  const auto& space = state.problem.space;
  Eigen::VectorXd pressure;
  if (state.problem.pressures) pressure = (*state.problem.pressures)(state.displacement);
  double sum = 0;
  int count = 0;
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e)
    for (int c = 0; c < 4; ++c) {
      if ((space.nodes[space.elements[e][c]] - Vector3d(2, 0, 0.6)).norm() > 1e-9) continue;
      sum += fine_stress(space, state.problem.materials, pressure.size() ? &pressure : nullptr, state.displacement, e,
                         Eigen::Vector4d::Unit(c))(1, 1);
      ++count;
    }
  return {sum / count, state.problem.dofs.size()};
}

}  // namespace palpate::bench
