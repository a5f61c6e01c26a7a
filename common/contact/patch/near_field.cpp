#include "common/contact/patch/near_field.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Triangle corners(const SurfaceMap& map, int t) {
  const auto& n = map.triangles[t];
  return {map.position[n[0]], map.position[n[1]], map.position[n[2]]};
}

Vector3d doubled_area(const Triangle& c) {
  return (c[1] - c[0]).cross(c[2] - c[0]);
}

double distance_between(const Triangle& a, const Triangle& b) {
  double least = (a[0] - b[0]).squaredNorm();
  for (const Vector3d& x : a)
    for (const Vector3d& y : b) least = std::min(least, (x - y).squaredNorm());
  return std::sqrt(least);
}

/// Coefficients of node `corner`'s dual function among the barycentric coordinates: 4 L_corner - 1.
Vector3d dual(int corner) {
  Vector3d c = Vector3d::Constant(-1);
  c[corner] = 3;
  return c;
}

}  // namespace

NearField::NearField(const SurfaceMap& map, double width) {
  find_edges(map);
  find_pairs(map, width);
}

std::size_t NearField::bytes_of(const SurfaceMap& map, double width) {
  return NearField(map, width).bytes();
}

NearField::NearField(const SurfaceMap& map, const Compliance<double>& compliance, const HalfSpace& half_space,
                     double width)
    : NearField(map, width) {
  take_half_space(map, half_space, width);
  for (int i = 0; i < map.size(); ++i)
    for (int k = first_[i]; k < first_[i + 1]; ++k) {
      const int j = neighbours_[k];
      blocks_[k] = -blocks_[k];
      if (i >= compliance.row_nodes() || j >= compliance.column_nodes()) continue;
      for (int axis = 0; axis < 3; ++axis)
        blocks_[k].col(axis) += Eigen::Map<const Vector3d>(compliance.column(j, axis) + 3 * i);
    }
}

void NearField::find_edges(const SurfaceMap& map) {
  edge_.assign(map.size(), 0.0);
  for (const auto& t : map.triangles)
    for (int v = 0; v < 3; ++v) {
      const int a = t[v], b = t[(v + 1) % 3];
      const double edge = (map.position[a] - map.position[b]).norm();
      edge_[a] = std::max(edge_[a], edge);
      edge_[b] = std::max(edge_[b], edge);
    }
}

void NearField::find_pairs(const SurfaceMap& map, double width) {
  const double longest = *std::ranges::max_element(edge_);
  std::vector<int> order(map.size());
  for (int n = 0; n < map.size(); ++n) order[n] = n;
  std::ranges::sort(order, {}, [&](int n) { return map.position[n].x(); });
  std::vector<std::vector<int>> near(map.size());
  for (std::size_t a = 0; a < order.size(); ++a)
    for (std::size_t b = a; b < order.size(); ++b) {
      const Vector3d apart = map.position[order[b]] - map.position[order[a]];
      if (apart.x() > width + 2 * longest) break;
      if (apart.norm() > width + edge_[order[a]] + edge_[order[b]]) continue;
      near[std::max(order[a], order[b])].push_back(std::min(order[a], order[b]));
    }
  first_.push_back(0);
  for (std::vector<int>& of_node : near) {
    std::ranges::sort(of_node);
    neighbours_.insert(neighbours_.end(), of_node.begin(), of_node.end());
    first_.push_back(static_cast<int>(neighbours_.size()));
  }
  blocks_.assign(neighbours_.size(), Matrix3d::Zero());
}

// Pair of triangles by pair of triangles, each once: what they give to the pairs of their corners.
void NearField::take_half_space(const SurfaceMap& map, const HalfSpace& half_space, double width) {
  const int count = static_cast<int>(map.triangles.size());
  std::vector<double> weight(map.size(), 0.0);  // [m^2] integral of each node's hat
  for (int t = 0; t < count; ++t)
    for (const int node : map.triangles[t]) weight[node] += doubled_area(corners(map, t)).norm() / 6;
  std::vector<int> order(count);
  std::vector<double> low(count), high(count);
  for (int t = 0; t < count; ++t) {
    const Triangle c = corners(map, t);
    order[t] = t;
    low[t] = std::min({c[0].x(), c[1].x(), c[2].x()});
    high[t] = std::max({c[0].x(), c[1].x(), c[2].x()});
  }
  std::ranges::sort(order, {}, [&](int t) { return low[t]; });
  const double longest = *std::ranges::max_element(edge_);
  const auto edge = [&](int t) {
    const auto& n = map.triangles[t];
    return std::max({edge_[n[0]], edge_[n[1]], edge_[n[2]]});
  };
  for (int a = 0; a < count; ++a)
    for (int b = a; b < count && low[order[b]] <= high[order[a]] + width + 2 * longest; ++b) {
      const int s = order[a], t = order[b];
      const Triangle of_s = corners(map, s), of_t = corners(map, t);
      const Vector3d n_s = doubled_area(of_s).normalized(), n_t = doubled_area(of_t).normalized();
      if (n_s.dot(n_t) <= 0 || distance_between(of_s, of_t) > width + edge(s) + edge(t)) continue;
      const auto moments = kernel_moments(half_space, of_s, of_t, (n_s + n_t).normalized());
      for (int p = 0; p < 3; ++p)
        for (int q = 0; q < 3; ++q) {
          const int i = map.triangles[s][p], j = map.triangles[t][q], at = place(std::max(i, j), std::min(i, j));
          if (at < 0 || (s == t && i < j)) continue;
          Matrix3d sum = Matrix3d::Zero();
          for (int x = 0; x < 3; ++x)
            for (int y = 0; y < 3; ++y) sum += dual(p)[x] * dual(q)[y] * moments[x][y];
          sum /= weight[i] * weight[j];
          if (i == j && s != t) sum += sum.transpose().eval();  // (t, s), the kernel being even
          blocks_[at] += i >= j ? sum : Matrix3d(sum.transpose());
        }
    }
}

int NearField::place(int i, int j) const {
  const auto begin = neighbours_.begin() + first_[i], end = neighbours_.begin() + first_[i + 1];
  const auto found = std::lower_bound(begin, end, j);
  return found != end && *found == j ? static_cast<int>(found - neighbours_.begin()) : -1;
}

Matrix3d NearField::between(int i, int j) const {
  const int at = place(std::max(i, j), std::min(i, j));
  if (at < 0) return Matrix3d::Zero();
  return i >= j ? blocks_[at] : Matrix3d(blocks_[at].transpose());
}

}  // namespace palpate
