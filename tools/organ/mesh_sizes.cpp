#include <algorithm>

#include "tools/organ/fill_solid.hpp"

namespace palpate {
namespace {

constexpr double kGrowth = 0.5;  // of the edge asked for, per length away from the surface or a fine place

}  // namespace

double FinePlace::distance(const Eigen::Vector3d& x) const {
  const Eigen::Vector3d outside = (low - x).cwiseMax(x - high).cwiseMax(0.0);
  return std::max(outside.norm() - radius, 0.0);
}

double asked_edge(const MeshSizes& sizes, const Eigen::Vector3d& x, double depth) {
  double edge = std::min(sizes.edge + kGrowth * depth, sizes.inside);
  for (const FinePlace& f : sizes.fine) edge = std::min(edge, f.edge + kGrowth * f.distance(x));
  return edge;
}

}  // namespace palpate
