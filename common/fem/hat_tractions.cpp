#include "common/fem/hat_tractions.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "common/fem/refine_mesh.hpp"
#include "common/fem/selection.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

FineFace face_of(const FineSpace& space, const std::array<int, 3>& corners, int element) {
  FineFace face{{corners[0], corners[1], corners[2], -1, -1, -1}, 3, element};
  if (space.per_element == 4) return face;
  const auto& nodes = space.elements[element];
  const auto local = [&](int node) {
    return static_cast<int>(std::find(nodes.begin(), nodes.begin() + 4, node) - nodes.begin());
  };
  for (int c = 0; c < 3; ++c) {
    int a = local(corners[c]), b = local(corners[(c + 1) % 3]);
    if (a > b) std::swap(a, b);
    for (int e = 0; e < 6; ++e)
      if (kTetEdges[e][0] == a && kTetEdges[e][1] == b) face.node[3 + c] = nodes[4 + e];
  }
  face.count = 6;
  return face;
}

/// int N_a L_c over a triangle, as a share of its area: L_c linear, N_a of a face with `count` nodes.
double share(int count, int a, int c) {
  if (count == 3) return a == c ? 1. / 6 : 1. / 12;
  if (a < 3) return a == c ? 1. / 30 : -1. / 60;
  const bool on_edge = c == a - 3 || c == (a - 2) % 3;
  return on_edge ? 2. / 15 : 1. / 15;
}

/// The linear shape function of a run-time node at a fine node.
double hat_at(const FineSpace& space, int fine_node, int run_time_node) {
  const auto& hats = space.interpolation[fine_node];
  for (int h = 0; h < hats.count; ++h)
    if (hats.node[h] == run_time_node) return hats.weight[h];
  return 0;
}

/// Shape function a of a face at barycentric coordinates.
double shape(int count, int a, const Eigen::Vector3d& at) {
  if (count == 3) return at[a];
  return a < 3 ? at[a] * (2 * at[a] - 1) : 4 * at[a - 3] * at[(a - 2) % 3];
}

/// Six points of degree 4 (Strang and Fix): two orbits of three.
constexpr double kOrbit[2][2] = {{0.445948490915965, 0.223381589678011}, {0.091576213509771, 0.109951743655322}};

}  // namespace

std::vector<FineFace> fine_surface(const FineSpace& space) {
  const auto surface = extract_surface(space.mesh);
  std::vector<FineFace> faces;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    faces.push_back(face_of(space, surface.triangles[t], surface.tetrahedra[t]));
  return faces;
}

std::array<int, 3> run_time_corners(const FineSpace& space, const FineFace& face) {
  std::array<int, 3> corners{-1, -1, -1};
  int count = 0;
  for (int c = 0; c < 3; ++c) {
    const auto& hats = space.interpolation[face.node[c]];
    for (int h = 0; h < hats.count; ++h)
      if (std::find(corners.begin(), corners.begin() + count, hats.node[h]) == corners.begin() + count)
        corners[count++] = hats.node[h];
  }
  return corners;
}

std::vector<Eigen::Vector3d> traction_loads(const FineSpace& space, const Traction& traction) {
  std::vector<Eigen::Vector3d> load(space.nodes.size(), Eigen::Vector3d::Zero());
  for (const auto& face : fine_surface(space)) {
    Eigen::Matrix3d corner;
    for (int c = 0; c < 3; ++c) corner.col(c) = space.nodes[face.node[c]];
    const Eigen::Vector3d area = 0.5 * (corner.col(1) - corner.col(0)).cross(corner.col(2) - corner.col(0));
    for (const auto& [far, weight] : kOrbit)
      for (int q = 0; q < 3; ++q) {
        Eigen::Vector3d at = Eigen::Vector3d::Constant(far);
        at[q] = 1 - 2 * far;
        const Eigen::Vector3d force = weight * area.norm() * traction(corner * at, area.normalized());
        for (int a = 0; a < face.count; ++a) load[face.node[a]] += shape(face.count, a, at) * force;
      }
  }
  return load;
}

SparseMatrix hat_tractions(const FineSpace& space, const TetMesh& run_time_mesh, SurfaceWeight weight) {
  std::vector<Eigen::Triplet<double, std::int64_t>> entries;
  std::vector<double> area(run_time_mesh.nodes.size(), 0.0);  // int phi_i
  for (const auto& face : fine_surface(space)) {
    const auto& x = space.nodes;
    const double size = 0.5 * (x[face.node[1]] - x[face.node[0]]).cross(x[face.node[2]] - x[face.node[0]]).norm();
    const auto corners = run_time_corners(space, face);
    for (int i = 0; i < 3; ++i) {
      area[corners[i]] += size / 3 *
                          (hat_at(space, face.node[0], corners[i]) + hat_at(space, face.node[1], corners[i]) +
                           hat_at(space, face.node[2], corners[i]));
      for (int c = 0; c < 3; ++c) {
        const double hat = hat_at(space, face.node[c], corners[i]),
                     value = weight == SurfaceWeight::hat ? hat : 4 * hat - 1;
        for (int a = 0; a < face.count; ++a)
          entries.emplace_back(face.node[a], corners[i], size * share(face.count, a, c) * value);
      }
    }
  }
  const auto used = used_nodes(run_time_mesh);
  for (std::size_t i = 0; i < area.size(); ++i) {
    if (area[i] > 0 || !used[i]) continue;
    area[i] = 1;
    entries.emplace_back(i, i, 1.0);
  }
  SparseMatrix hats(static_cast<std::int64_t>(space.nodes.size()), static_cast<std::int64_t>(area.size()));
  hats.setFromTriplets(entries.begin(), entries.end());
  for (std::int64_t i = 0; i < hats.outerSize(); ++i)
    for (SparseMatrix::InnerIterator it(hats, i); it; ++it) it.valueRef() /= area[i];
  return hats;
}

}  // namespace palpate
