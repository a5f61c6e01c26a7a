#include "common/mesh/visual_binding.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "common/geometry/triangle.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

struct Nearest {
  Eigen::Vector4d weight = Eigen::Vector4d::Zero();
  double squared_distance = std::numeric_limits<double>::infinity();
};

/// A ball about a cell: cells whose ball is farther away than what was found need no closer look.
struct Ball {
  Vector3d middle;
  double radius;
};

class Search {
 public:
  Search(const std::vector<std::array<int, 4>>& cells, std::span<const Vector3d> nodes) : cells_(cells), nodes_(nodes) {
    for (const auto& cell : cells_) balls_.push_back(ball_about(cell));
  }

  /// `guess`: a cell that is likely near.
  VisualBinding::Tie tie(const Vector3d& p, int guess) const {
    int best = guess;
    Nearest nearest = nearest_of(p, cells_[guess]);
    for (std::size_t c = 0; c < cells_.size() && nearest.squared_distance > 0; ++c) {
      const double reach = balls_[c].radius + std::sqrt(nearest.squared_distance);
      if ((p - balls_[c].middle).squaredNorm() > reach * reach) continue;
      const Nearest here = nearest_of(p, cells_[c]);
      if (here.squared_distance >= nearest.squared_distance) continue;
      nearest = here;
      best = static_cast<int>(c);
    }
    const Eigen::Vector4f w = nearest.weight.cast<float>();
    return {best, {w[0], w[1], w[2], w[3]}, static_cast<float>(std::sqrt(nearest.squared_distance))};
  }

 private:
  static int corners(const std::array<int, 4>& cell) { return cell[3] < 0 ? 3 : 4; }

  Ball ball_about(const std::array<int, 4>& cell) const {
    Ball ball{Vector3d::Zero(), 0};
    for (int k = 0; k < corners(cell); ++k) ball.middle += nodes_[cell[k]] / corners(cell);
    for (int k = 0; k < corners(cell); ++k) ball.radius = std::max(ball.radius, (nodes_[cell[k]] - ball.middle).norm());
    return ball;
  }

  Nearest nearest_of(const Vector3d& p, const std::array<int, 4>& cell) const {
    if (cell[3] < 0) return nearest_of_face(p, cell, {0, 1, 2});
    const Vector3d& origin = nodes_[cell[0]];
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = nodes_[cell[k + 1]] - origin;
    const Vector3d inner = edges.inverse() * (p - origin);
    if (inner.minCoeff() >= 0 && inner.sum() <= 1) return {{1 - inner.sum(), inner[0], inner[1], inner[2]}, 0};
    Nearest nearest;
    for (const auto& face : kTetFaces) {
      const Nearest here = nearest_of_face(p, cell, {face[0], face[1], face[2]});
      if (here.squared_distance < nearest.squared_distance) nearest = here;
    }
    return nearest;
  }

  Nearest nearest_of_face(const Vector3d& p, const std::array<int, 4>& cell, const std::array<int, 3>& face) const {
    const ClosestPoint closest =
        closest_point(p, {nodes_[cell[face[0]]], nodes_[cell[face[1]]], nodes_[cell[face[2]]]});
    Nearest nearest;
    for (int k = 0; k < 3; ++k) nearest.weight[face[k]] = closest.weights[k];
    nearest.squared_distance = closest.squared_distance;
    return nearest;
  }

  const std::vector<std::array<int, 4>>& cells_;
  std::span<const Vector3d> nodes_;
  std::vector<Ball> balls_;
};

std::array<int, 3> in_order(std::array<int, 3> t) {
  std::ranges::sort(t);
  return t;
}

}  // namespace

VisualBinding bind_visual(std::span<const Eigen::Vector3f> vertices, std::span<const Vector3d> nodes,
                          std::span<const std::array<int, 3>> triangles,
                          std::span<const std::array<int, 4>> tetrahedra) {
  VisualBinding binding;
  binding.cells.assign(tetrahedra.begin(), tetrahedra.end());
  binding.tetrahedra = static_cast<int>(tetrahedra.size());
  std::set<std::array<int, 3>> faces;
  for (const auto& t : tetrahedra)
    for (const auto& face : kTetFaces) faces.insert(in_order({t[face[0]], t[face[1]], t[face[2]]}));
  for (const auto& t : triangles)
    if (!faces.contains(in_order(t))) binding.cells.push_back({t[0], t[1], t[2], -1});

  const Search search(binding.cells, nodes);
  int guess = 0;
  for (const Eigen::Vector3f& p : vertices) {
    binding.ties.push_back(search.tie(p.cast<double>(), guess));
    guess = binding.ties.back().cell;
  }
  return binding;
}

}  // namespace palpate
