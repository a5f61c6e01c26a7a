#pragma once
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numeric>

#include "bench/disc_load.hpp"
#include "common/fem/fine_problem.hpp"
#include "common/mesh/surface.hpp"
#include "tests/fem/meshes_for_tests.hpp"

/// The named box of the 2 % claim: 1 x 1 x 0.5 m, E = 1 Pa, base fixed, a disc of radius 0.25 m in the middle of the
/// top under a uniform normal traction of resultant 1 N. Its answer is the mean normal displacement of the disc [m].
namespace palpate::testing {

using bench::kDisc;

/// The box with its inner nodes moved at random by up to 0.3 of a cell along each axis, less where a tetrahedron would
/// keep less than a tenth of its volume.
inline TetMesh make_disc_box(int cells, unsigned seed = 1) {
  const auto regular = make_block(Eigen::Vector3d::Zero(), {1, 1, 0.5}, {cells, cells, cells / 2});
  auto mesh = make_jittered_block({1, 1, 0.5}, {cells, cells, cells / 2}, 0.3, seed);
  const auto volume = [](const TetMesh& m, const std::array<int, 4>& t) {
    return (m.nodes[t[1]] - m.nodes[t[0]]).cross(m.nodes[t[2]] - m.nodes[t[0]]).dot(m.nodes[t[3]] - m.nodes[t[0]]);
  };
  for (bool good = false; !good;) {
    good = true;
    for (const auto& tet : mesh.tetrahedra) {
      if (volume(mesh, tet) > 0.1 * volume(regular, tet)) continue;
      good = false;
      for (int node : tet) mesh.nodes[node] = 0.5 * (mesh.nodes[node] + regular.nodes[node]);
    }
  }
  return mesh;
}

/// int over the disc of the three linear shape functions of a triangle in the plane of the top; triangles that the rim
/// crosses are cut in four `depth` times.
inline Eigen::Vector3d disc_integral(const std::array<Eigen::Vector2d, 3>& x, int depth) {
  const double size = 0.5 * std::abs((x[1] - x[0]).x() * (x[2] - x[0]).y() - (x[1] - x[0]).y() * (x[2] - x[0]).x());
  const int inside = (x[0].norm() < kDisc) + (x[1].norm() < kDisc) + (x[2].norm() < kDisc);
  const double reach = std::max({(x[1] - x[0]).norm(), (x[2] - x[1]).norm(), (x[0] - x[2]).norm()});
  const Eigen::Vector2d middle = (x[0] + x[1] + x[2]) / 3;
  if (inside == 3) return Eigen::Vector3d::Constant(size / 3);
  if (middle.norm() > kDisc + reach) return Eigen::Vector3d::Zero();
  if (depth == 0) return middle.norm() < kDisc ? Eigen::Vector3d::Constant(size / 3) : Eigen::Vector3d::Zero();
  const std::array<Eigen::Vector2d, 3> m{(x[0] + x[1]) / 2, (x[1] + x[2]) / 2, (x[2] + x[0]) / 2};
  const Eigen::Vector3d a = disc_integral({x[0], m[0], m[2]}, depth - 1),
                        b = disc_integral({m[0], x[1], m[1]}, depth - 1),
                        c = disc_integral({m[2], m[1], x[2]}, depth - 1),
                        d = disc_integral({m[0], m[1], m[2]}, depth - 1);
  Eigen::Vector3d sum;
  sum[0] = a[0] + 0.5 * (a[1] + a[2] + b[0] + c[0] + d[0] + d[2]);
  sum[1] = b[1] + 0.5 * (a[1] + b[0] + b[2] + c[1] + d[0] + d[1]);
  sum[2] = c[2] + 0.5 * (a[2] + c[0] + b[2] + c[1] + d[1] + d[2]);
  return sum;
}

/// int over the disc of the linear hats of a mesh's top, per node. The disc's centre is `centre`.
inline std::vector<double> disc_hats(const TetMesh& mesh, const Eigen::Vector2d& centre) {
  std::vector<double> share(mesh.nodes.size(), 0.0);
  double top = 0;
  for (const auto& x : mesh.nodes) top = std::max(top, x.z());
  for (const auto& triangle : extract_surface(mesh).triangles) {
    std::array<Eigen::Vector2d, 3> x;
    bool on_top = true;
    for (int c = 0; c < 3; ++c) {
      on_top = on_top && mesh.nodes[triangle[c]].z() > top - 1e-9;
      x[c] = mesh.nodes[triangle[c]].head<2>() - centre;
    }
    if (!on_top) continue;
    const Eigen::Vector3d part = disc_integral(x, 6);
    for (int c = 0; c < 3; ++c) share[triangle[c]] += part[c];
  }
  return share;
}

inline double disc_work(const std::vector<Eigen::Vector3d>& force, const std::vector<Eigen::Vector3d>& displacement) {
  double sum = 0;
  for (std::size_t i = 0; i < force.size(); ++i) sum += force[i].dot(displacement[i]);
  return sum;
}

}  // namespace palpate::testing
