#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "common/fem/hat_tractions.hpp"

/// A disc of uniform pressure on quadratic or linear faces that its rim crosses.
namespace palpate::bench {

inline constexpr double kDisc = 0.25;  ///< [m] radius

/// Adds int over the disc of the `count` shape functions of a face to `sum`. The columns of `at` are the
/// barycentric coordinates of x in that face.
inline void add_disc(const std::array<Eigen::Vector2d, 3>& x, const Eigen::Matrix3d& at, int depth, int count,
                     Eigen::Matrix<double, 6, 1>& sum) {
  const int inside = (x[0].norm() < kDisc) + (x[1].norm() < kDisc) + (x[2].norm() < kDisc);
  const double reach = std::max({(x[1] - x[0]).norm(), (x[2] - x[1]).norm(), (x[0] - x[2]).norm()});
  const Eigen::Vector2d middle = (x[0] + x[1] + x[2]) / 3;
  if (middle.norm() > kDisc + reach || (inside < 3 && depth == 0 && middle.norm() >= kDisc)) return;
  if (inside < 3 && depth > 0) {
    const std::array<Eigen::Vector2d, 3> m{(x[0] + x[1]) / 2, (x[1] + x[2]) / 2, (x[2] + x[0]) / 2};
    const Eigen::Vector3d a = at.col(0), b = at.col(1), c = at.col(2), ab = (a + b) / 2, bc = (b + c) / 2,
                          ca = (c + a) / 2;
    const auto columns = [](const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r) {
      Eigen::Matrix3d matrix;
      matrix << p, q, r;
      return matrix;
    };
    add_disc({x[0], m[0], m[2]}, columns(a, ab, ca), depth - 1, count, sum);
    add_disc({m[0], x[1], m[1]}, columns(ab, b, bc), depth - 1, count, sum);
    add_disc({m[2], m[1], x[2]}, columns(ca, bc, c), depth - 1, count, sum);
    add_disc({m[0], m[1], m[2]}, columns(ab, bc, ca), depth - 1, count, sum);
    return;
  }
  const double size = 0.5 * std::abs((x[1] - x[0]).x() * (x[2] - x[0]).y() - (x[1] - x[0]).y() * (x[2] - x[0]).x());
  for (int q = 0; q < 3; ++q) {
    const Eigen::Vector3d l = (at.col(q) + at.col((q + 1) % 3)) / 2;
    for (int c = 0; c < 3; ++c) {
      sum[c] += size / 3 * (count == 6 ? l[c] * (2 * l[c] - 1) : l[c]);
      if (count == 6) sum[3 + c] += size / 3 * 4 * l[c] * l[(c + 1) % 3];
    }
  }
}

/// Consistent loads [N] along z of a uniform disc about the z axis on the plane z = `plane` of a body's
/// surface.
inline std::vector<Eigen::Vector3d> disc_loads(const FineSpace& space, double plane, double resultant) {
  std::vector<Eigen::Vector3d> load(space.nodes.size(), Eigen::Vector3d::Zero());
  double whole = 0;
  for (const auto& face : fine_surface(space)) {
    bool on_plane = true;
    std::array<Eigen::Vector2d, 3> x;
    for (int c = 0; c < 3; ++c) {
      on_plane = on_plane && std::abs(space.nodes[face.node[c]].z() - plane) < 1e-9;
      x[c] = space.nodes[face.node[c]].head<2>();
    }
    if (!on_plane) continue;
    Eigen::Matrix<double, 6, 1> part = Eigen::Matrix<double, 6, 1>::Zero();
    add_disc(x, Eigen::Matrix3d::Identity(), 6, face.count, part);
    for (int a = 0; a < face.count; ++a) {
      load[face.node[a]].z() += part[a];
      whole += part[a];
    }
  }
  for (auto& f : load) f *= resultant / whole;
  return load;
}

}  // namespace palpate::bench
