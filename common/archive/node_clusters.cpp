#include "common/archive/node_clusters.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace palpate {
namespace {

constexpr int kLeaf = 64;      // nodes at most
constexpr double kFar = 0.25;  // [1] distance in widths of either cluster

struct Cluster {
  int begin, end;  // places
  Eigen::AlignedBox3d box;
  int first_half = -1, second_half = -1;

  bool leaf() const { return first_half < 0; }
  double width() const { return box.diagonal().norm(); }
};

class Tree {
 public:
  Tree(const SurfaceMap& surface, std::vector<int>& order, int begin, int end) : surface_(surface), order_(order) {
    if (begin < end) halve(begin, end);
  }
  const std::vector<Cluster>& clusters() const { return clusters_; }

 private:
  int halve(int begin, int end) {
    const int own = static_cast<int>(clusters_.size());
    clusters_.push_back({begin, end, {}});
    for (int p = begin; p < end; ++p) clusters_[own].box.extend(surface_.position[order_[p]]);
    if (end - begin <= kLeaf) return own;
    Eigen::Index axis = 0;
    clusters_[own].box.sizes().maxCoeff(&axis);
    const int middle = begin + (end - begin) / 2;
    const auto at = [&](int place) { return order_.begin() + place; };
    std::nth_element(at(begin), at(middle), at(end), [&](int i, int j) {
      const double x = surface_.position[i][axis], y = surface_.position[j][axis];
      return x != y ? x < y : i < j;
    });
    const int first = halve(begin, middle), second = halve(middle, end);
    clusters_[own].first_half = first;
    clusters_[own].second_half = second;
    return own;
  }

  const SurfaceMap& surface_;
  std::vector<int>& order_;
  std::vector<Cluster> clusters_;
};

/// Blocks of a leaf's columns.
class Pairing {
 public:
  Pairing(const Cluster& leaf, std::vector<ComplianceBlock>& blocks) : leaf_(leaf), blocks_(blocks) {}

  void with(const std::vector<Cluster>& clusters, int of = 0) {
    if (clusters.empty()) return;
    const Cluster& row = clusters[of];
    if (row.end <= leaf_.begin) return;  // above the diagonal
    const double apart = leaf_.box.exteriorDistance(row.box);
    const bool far = row.begin >= leaf_.end && apart > kFar * std::max(leaf_.width(), row.width());
    if (!far && !row.leaf()) {
      with(clusters, row.first_half);
      with(clusters, row.second_half);
      return;
    }
    blocks_.push_back({row.begin, row.end, leaf_.begin, leaf_.end, far ? 0 : ComplianceBlock::kDense});
  }

 private:
  const Cluster& leaf_;
  std::vector<ComplianceBlock>& blocks_;
};

void append_free(const SurfaceMap& surface, int begin, int end, std::vector<int>& order) {
  for (int n = begin; n < end; ++n)
    if (std::ranges::count(surface.fixed[n], false) > 0) order.push_back(n);
}

}  // namespace

BlockPlan plan_blocks(const SurfaceMap& surface) {
  BlockPlan plan;
  append_free(surface, 0, surface.touchable, plan.order);
  plan.touchable = static_cast<int>(plan.order.size());
  append_free(surface, surface.touchable, surface.size(), plan.order);
  const Tree touchable(surface, plan.order, 0, plan.touchable);
  const Tree others(surface, plan.order, plan.touchable, static_cast<int>(plan.order.size()));
  for (const Cluster& leaf : touchable.clusters()) {
    if (!leaf.leaf()) continue;
    Pairing pairing(leaf, plan.blocks);
    pairing.with(touchable.clusters());
    pairing.with(others.clusters());
  }
  return plan;
}

}  // namespace palpate
