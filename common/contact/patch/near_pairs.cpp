#include "common/contact/patch/near_pairs.hpp"

#include <algorithm>
#include <numeric>

namespace palpate {

using Eigen::Vector3d;

void for_each_near_pair(std::span<const Vector3d> points, std::span<const double> reach,
                        const std::function<void(int i, int j)>& visit) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](int n) { return points[n].x(); });
  const double longest = *std::ranges::max_element(reach);
  for (std::size_t a = 0; a < order.size(); ++a)
    for (std::size_t b = a; b < order.size(); ++b) {
      const int i = order[a], j = order[b];
      const Vector3d apart = points[j] - points[i];
      if (!(apart.x() <= reach[i] + longest)) break;
      if (apart.norm() <= reach[i] + reach[j]) visit(i, j);
    }
}

NearPairs::NearPairs(std::span<const Vector3d> points, std::span<const double> reach) {
  std::vector<std::vector<int>> near(points.size());
  for_each_near_pair(points, reach, [&](int i, int j) { near[std::max(i, j)].push_back(std::min(i, j)); });
  first_.push_back(0);
  for (std::vector<int>& of_point : near) {
    std::ranges::sort(of_point);
    neighbours_.insert(neighbours_.end(), of_point.begin(), of_point.end());
    first_.push_back(static_cast<int>(neighbours_.size()));
  }
  blocks_.assign(neighbours_.size(), Eigen::Matrix3d::Zero());
}

const Eigen::Matrix3d* NearPairs::find(int i, int j) const {
  const std::span<const int> near = lower(i);
  const auto found = std::ranges::lower_bound(near, j);
  return found != near.end() && *found == j ? &blocks_[first_[i] + (found - near.begin())] : nullptr;
}

}  // namespace palpate
