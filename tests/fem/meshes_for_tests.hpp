#pragma once
#include <array>
#include <cmath>
#include <random>

#include "common/mesh/generators.hpp"
#include "common/models/quasi_static/spec.hpp"

namespace palpate::testing {

/// A block whose inner nodes are moved at random by up to `share` of a cell; the outer faces stay flat.
inline TetMesh make_jittered_block(const Eigen::Vector3d& extent, const std::array<int, 3>& cells, double share,
                                   unsigned seed = 1) {
  auto mesh = make_block(Eigen::Vector3d::Zero(), extent, cells);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-share, share);
  for (auto& node : mesh.nodes)
    for (int axis = 0; axis < 3; ++axis) {
      const double step = jitter(random) * extent[axis] / cells[axis];
      const bool inner = node[axis] > 1e-9 * extent[axis] && node[axis] < (1 - 1e-9) * extent[axis];
      if (inner) node[axis] += step;
    }
  return mesh;
}

/// A smooth, rounded, curved body of unequal elements, standing on its bottom: about as irregular as an
/// organ.
inline TetMesh make_organ(const std::array<int, 3>& cells) {
  auto mesh = make_jittered_block({1, 1, 1}, cells, 0.15);
  for (auto& node : mesh.nodes) {
    const double u = 2 * node.x() - 1, v = 2 * node.y() - 1, w = node.z();
    const double round = 1 - 0.25 * (u * u + v * v);
    node = {0.10 * u * (1 - 0.2 * v * v), 0.07 * v * (1 - 0.2 * u * u) + 0.02 * u * u, 0.06 * w * round + 0.02 * u * w};
  }
  return mesh;
}

inline BoundaryCondition fix_group(const std::string& group, std::array<bool, 3> axes = {true, true, true}) {
  BoundaryCondition region;
  region.where.group = group;
  region.axes = axes;
  return region;
}

inline BoundaryCondition fix_nodes(std::vector<int> nodes, std::array<bool, 3> axes = {true, true, true}) {
  BoundaryCondition region;
  region.where.indices = std::move(nodes);
  region.axes = axes;
  return region;
}

/// A body of one material that stands on the group `bottom`.
inline QuasiStaticSpec make_body(double young = 10e3, double poisson = 0.45) {
  QuasiStaticSpec body;
  body.name = "organ";
  body.material = {young, poisson, 1000};
  body.fixed = {fix_group("bottom")};
  return body;
}

/// max |a - b| over max |b|.
inline double relative_difference(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    difference = std::max(difference, (a[i] - b[i]).cwiseAbs().maxCoeff());
    size = std::max(size, b[i].cwiseAbs().maxCoeff());
  }
  return difference / size;
}

}  // namespace palpate::testing
