#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace palpate {

/// Calls `visit(i, j)` for all pairs of points with |x_i - x_j| <= reach_i + reach_j, each once, those with themselves
/// among them.
void for_each_near_pair(std::span<const Eigen::Vector3d> points, std::span<const double> reach,
                        const std::function<void(int i, int j)>& visit);

/// A matrix of 3 x 3 blocks among points that are near each other, symmetric under (i, j) and transposition.
class NearPairs {
 public:
  /// `reach` [m]: of each point, as in for_each_near_pair(); of points that are near none, kNone. All blocks are zero.
  NearPairs(std::span<const Eigen::Vector3d> points, std::span<const double> reach);
  static constexpr double kNone = -std::numeric_limits<double>::infinity();

  /// Points j <= i that are near i, ascending, and their blocks (i, j).
  std::span<const int> lower(int i) const {
    return std::span(neighbours_).subspan(first_[i], first_[i + 1] - first_[i]);
  }
  std::span<Eigen::Matrix3d> lower_blocks(int i) {
    return std::span(blocks_).subspan(first_[i], first_[i + 1] - first_[i]);
  }
  /// Block (i, j), i >= j; null where they are not near.
  const Eigen::Matrix3d* find(int i, int j) const;
  Eigen::Matrix3d* find(int i, int j) { return const_cast<Eigen::Matrix3d*>(std::as_const(*this).find(i, j)); }

  std::size_t bytes() const { return blocks_.size() * sizeof blocks_[0] + neighbours_.size() * sizeof neighbours_[0]; }

 private:
  std::vector<int> first_, neighbours_;  ///< of point i, those j <= i that are near: neighbours_[first_[i] ..]
  std::vector<Eigen::Matrix3d> blocks_;  ///< like neighbours_
};

}  // namespace palpate
