#include "common/contact/patch/near_field.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kAveraged = 1.5;  // radii about a node, at least

/// Nodes of the triangles that can be touched.
std::vector<bool> pressed_nodes(const SurfaceMap& map) {
  std::vector<bool> pressed(map.size(), false);
  for (const auto& t : map.triangles)
    if (std::ranges::min(t) < map.touchable)
      for (const int n : t) pressed[n] = true;
  return pressed;
}

/// Half the width `radius` of a patch, and the longest edge at the node: all pairs whose hats can reach into one patch.
std::vector<double> reach_of_patches(const SurfaceMap& map, double radius) {
  const std::vector<bool> pressed = pressed_nodes(map);
  std::vector<double> reach = longest_edges(map);
  for (int n = 0; n < map.size(); ++n) reach[n] = pressed[n] ? radius + reach[n] : NearPairs::kNone;
  return reach;
}

/// Whether a node's compliance is known: touchable, or held.
bool is_known(const SurfaceMap& map, int n) {
  return n < map.touchable || std::ranges::count(map.fixed[n], true) == 3;
}

/// A share of a node in an average.
struct Share {
  int node;
  double weight;
};
using Averages = std::vector<std::vector<Share>>;  // per node

/// Of the nodes that can be pressed, over those whose compliance is known.
Averages averages_of(const SmoothSurface& surface, double radius, double resolved) {
  const SurfaceMap& map = surface.map();
  const std::vector<bool> pressed = pressed_nodes(map);
  std::vector<double> width;
  for (int n = 0; n < map.size(); ++n)
    width.push_back(std::max(kAveraged * radius, resolved * std::sqrt(surface.weight(n))));
  Averages averages(map.size());
  const auto add = [&](int i, int k) {
    const double far = (map.position[i] - map.position[k]).squaredNorm() / (width[i] * width[i]);
    const double facing = surface.node_normal(i).dot(surface.node_normal(k));
    if (pressed[i] && far < 1 && facing > 0 && is_known(map, k))
      averages[i].push_back({k, facing * (1 - far) * (1 - far) * surface.weight(k)});
  };
  for_each_near_pair(map.position, width, [&](int i, int k) {
    add(i, k);
    if (i != k) add(k, i);
  });
  for (auto& of_node : averages) {
    double sum = 0;
    for (const Share& s : of_node) sum += s.weight;
    for (Share& s : of_node) s.weight /= sum;
  }
  return averages;
}

std::vector<bool> nodes_of(const Averages& averages) {
  std::vector<bool> nodes(averages.size(), false);
  for (const auto& of_node : averages)
    for (const Share& s : of_node) nodes[s.node] = true;
  return nodes;
}

/// Per node those whose average it is in, with its weight there.
Averages transposed(const Averages& averages) {
  Averages result(averages.size());
  for (std::size_t n = 0; n < averages.size(); ++n)
    for (const Share& s : averages[n]) result[s.node].push_back({static_cast<int>(n), s.weight});
  return result;
}

/// [m/N] Adds C between two nodes; zero beyond those that can be touched.
void add_compliance(const Compliance<double>& c, int i, int j, Matrix3d& to) {
  if (i >= c.row_nodes() || j >= c.column_nodes()) return;
  to += c.block(i, j);
}

/// [m/N] C - W^T G W between two nodes.
class Beyond {
 public:
  Beyond(const SmoothSurface& surface, const Compliance<double>& compliance, const HalfSpace& half_space,
         const std::vector<bool>& nodes)
      : compliance_(compliance), half_space_(surface, half_space, nodes) {}
  Matrix3d operator()(int i, int j) const {
    Matrix3d beyond = -half_space_.between(i, j);
    add_compliance(compliance_, i, j, beyond);
    return beyond;
  }

 private:
  const Compliance<double>& compliance_;
  const HatKernel half_space_;
};

}  // namespace

double widest_patch(const SurfaceMap& map) {
  Vector3d low = map.position[0], high = low;
  for (const Vector3d& p : map.position) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return 0.6 * (high - low).maxCoeff();
}

NearField::NearField(const SmoothSurface& surface, const Compliance<double>& compliance, const HalfSpace& half_space,
                     double radius, double resolved)
    : surface_(surface),
      compliance_(&compliance),
      half_space_(half_space),
      pairs_(surface.map().position, reach_of_patches(surface.map(), radius)) {
  const int count = surface.map().size();
  const Averages averages = averages_of(surface, radius, resolved);
  const Averages averaged_by = transposed(averages);
  const Beyond beyond(surface, compliance, half_space, nodes_of(averages));
  // Of node `to`, once each: C - W^T G W, and S (C - W^T G W), with the node that they were last worked out for.
  std::vector<Matrix3d> plain(count), averaged(count);
  std::vector<int> plain_for(count, -1), averaged_for(count, -1);
  const auto average = [&](int i, int to) -> const Matrix3d& {
    if (std::exchange(averaged_for[i], to) == to) return averaged[i];
    averaged[i].setZero();
    for (const Share& from : averages[i]) {
      if (std::exchange(plain_for[from.node], to) != to) plain[from.node] = beyond(from.node, to);
      averaged[i] += from.weight * plain[from.node];
    }
    return averaged[i];
  };
  for (int to = 0; to < count; ++to)
    for (const Share& by : averaged_by[to]) {
      const std::span<const int> near = pairs_.lower(by.node);
      const std::span<Matrix3d> blocks = pairs_.lower_blocks(by.node);
      for (std::size_t n = 0; n < near.size(); ++n) blocks[n] += by.weight * average(near[n], to).transpose();
    }
}

void NearField::subtract(const Compliance<double>& compliance) {
  compliance_ = nullptr;
  for (int i = 0; i < compliance.row_nodes(); ++i) {
    const std::span<const int> near = pairs_.lower(i);
    for (std::size_t n = 0; n < near.size(); ++n) pairs_.lower_blocks(i)[n] -= compliance.block(i, near[n]);
  }
}

std::size_t NearField::bytes_of(const SurfaceMap& map, double radius) {
  return NearPairs(map.position, reach_of_patches(map, radius)).bytes();
}

Matrix3d NearField::between(int i, int j) const {
  const Matrix3d* block = pairs_.find(std::max(i, j), std::min(i, j));
  if (!block) return far(i, j);
  return i >= j ? *block : Matrix3d(block->transpose());
}

// Of a node whose compliance nobody knows nothing can be said beyond the half-space.
Matrix3d NearField::far(int i, int j) const {
  if (i == j || !is_known(surface_.map(), i) || !is_known(surface_.map(), j)) return Matrix3d::Zero();
  Matrix3d beyond = -HatKernel::far(surface_, half_space_, i, j);
  if (compliance_) add_compliance(*compliance_, i, j, beyond);
  return beyond;
}

}  // namespace palpate
