#pragma once
#include <numbers>

#include "bench/disc_load.hpp"
#include "bench/exact_fields.hpp"
#include "common/mesh/generators.hpp"

/// Forces in infinite and half-infinite bodies: Kelvin, Boussinesq, and a disc under uniform pressure. A
/// quarter or an eighth of the surroundings is meshed out to 1 m, where it moves as the closed form says. E =
/// 1 Pa, force 1 N.
namespace palpate::bench {

using Eigen::Vector3d;

/// Kelvin: displacement around a unit force along z in an infinite body, zero at the force itself.
inline Vector3d kelvin(const Vector3d& x, double poisson) {
  const double r = x.norm(), shear = 0.5 / (1 + poisson);
  if (r == 0) return Vector3d::Zero();
  return ((3 - 4 * poisson) * Vector3d::UnitZ() + x * (x.z() / (r * r))) /
         (16 * std::numbers::pi * shear * (1 - poisson) * r);
}

/// Boussinesq: the same under a unit force along z on the plane z = 0 of the body z > 0.
inline Vector3d boussinesq(const Vector3d& x, double poisson) {
  const double r = x.norm(), shear = 0.5 / (1 + poisson);
  if (r == 0) return Vector3d::Zero();
  const Vector3d across(x.x(), x.y(), 0);
  const Vector3d moved = across * (x.z() / (r * r * r) - (1 - 2 * poisson) / (r * (r + x.z()))) +
                         (2 * (1 - poisson) / r + x.z() * x.z() / (r * r * r)) * Vector3d::UnitZ();
  return moved / (4 * std::numbers::pi * shear);
}

/// The same of a unit force spread evenly over the disc, outside it: Gauss points along the radius, equal
/// steps around.
inline Vector3d pressed_disc(const Vector3d& x, double poisson) {
  constexpr int around = 16;
  constexpr double at[4] = {0.0694318442, 0.3300094782, 0.6699905218, 0.9305681558};
  constexpr double weight[4] = {0.1739274226, 0.3260725774, 0.3260725774, 0.1739274226};
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < 4; ++i)  // the square of the radius is even over the area
    for (int k = 0; k < around; ++k) {
      const double r = kDisc * std::sqrt(at[i]), angle = 2 * std::numbers::pi * (k + 0.5) / around;
      sum += weight[i] / around * boussinesq(x - r * Vector3d(std::cos(angle), std::sin(angle), 0), poisson);
    }
  return sum;
}

/// Its mean displacement over the disc, 16 (1 - nu^2) P / (3 pi^2 E a).
inline double pressed_disc_mean(double poisson) {
  return 16 * (1 - poisson * poisson) / (3 * std::numbers::pi * std::numbers::pi * kDisc);
}

/// The unit cube whose faces x = 0 and y = 0 are planes of symmetry; the three far faces are held on all
/// axes, and the face z = 0 along x and y where `odd` (Kelvin's plane of antisymmetry).
inline FineProblem quarter_space(const TetMesh& mesh, double poisson, const Offline& offline, bool odd) {
  const auto held = [odd](const Vector3d& x, int axis) {
    const bool far = x.maxCoeff() > 1 - 1e-9;
    return far || (axis < 2 && (x[axis] < 1e-9 || (odd && x.z() < 1e-9)));
  };
  return make_held_problem(mesh, {1, poisson, 1}, offline, held);
}

/// Displacement along a point force, ahead of it on its line and beside it, in steps of the run-time mesh.
struct PointAnswer {
  std::vector<double> ahead, beside;  ///< at 1/n, 2/n, ... (n - 1)/n
  std::vector<double> exact_ahead, exact_beside;
  int unknowns;
};

inline PointAnswer point_force(int n, const Offline& offline, double poisson, bool in_infinite_body) {
  const auto mesh = make_block(Vector3d::Zero(), Vector3d::Ones(), {n, n, n});
  const auto problem = quarter_space(mesh, poisson, offline, in_infinite_body);
  const auto exact = [=](const Vector3d& x) { return in_infinite_body ? kelvin(x, poisson) : boussinesq(x, poisson); };
  std::vector<Vector3d> load(problem.space.nodes.size(), Vector3d::Zero());
  load[node_at(problem.space, Vector3d::Zero())].z() = in_infinite_body ? 0.125 : 0.25;
  const auto moved = solve_held(problem, exact, load);
  PointAnswer answer{{}, {}, {}, {}, problem.dofs.size()};
  for (int k = 1; k < n; ++k) {
    const Vector3d ahead = double(k) / n * Vector3d::UnitZ(), beside = double(k) / n * Vector3d::UnitX();
    answer.ahead.push_back(moved[node_at(problem.space, ahead)].z());
    answer.beside.push_back(moved[node_at(problem.space, beside)].z());
    answer.exact_ahead.push_back(exact(ahead).z());
    answer.exact_beside.push_back(exact(beside).z());
  }
  return answer;
}

struct DiscAnswer {
  double value;  ///< [m] mean displacement of the disc
  int unknowns;
};

/// The disc of radius 1/4 m, a quarter of it, on irregular tetrahedra.
inline DiscAnswer solve_disc(const TetMesh& mesh, const Offline& offline, double poisson) {
  const auto problem = quarter_space(mesh, poisson, offline, false);
  const auto load = disc_loads(problem.space, 0, 0.25);
  const auto moved = solve_held(
      problem, [=](const Vector3d& x) { return pressed_disc(x, poisson); }, load);
  double work = 0;
  for (std::size_t i = 0; i < load.size(); ++i) work += load[i].dot(moved[i]);
  return {4 * work, problem.dofs.size()};
}

}  // namespace palpate::bench
