#include "common/dynamics/tearing.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

namespace palpate {
namespace {

double six_volumes(const Corners& x) {
  return (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]);
}

/// Calls take((l - l0) / l0) for each edge.
template <class Take>
void each_elongation(const Corners& rest, const Corners& present, Take&& take) {
  for (int a = 0; a < 3; ++a)
    for (int b = a + 1; b < 4; ++b) {
      const double length = (rest[b] - rest[a]).norm();
      take(((present[b] - present[a]).norm() - length) / length);
    }
}

double measure_of(TearCriterion criterion, const Corners& rest, const Corners& present) {
  switch (criterion) {
    case TearCriterion::volume:
      return volume_change(rest, present);
    case TearCriterion::mean_elongation:
      return mean_elongation(rest, present);
    case TearCriterion::max_elongation:
      break;
  }
  return max_elongation(rest, present);
}

Corners corners_at(const std::array<int, 4>& nodes, std::span<const Eigen::Vector3d> position) {
  return {position[nodes[0]], position[nodes[1]], position[nodes[2]], position[nodes[3]]};
}

}  // namespace

double volume_change(const Corners& rest, const Corners& present) {
  const double before = six_volumes(rest);
  return std::abs(six_volumes(present) - before) / std::abs(before);
}

double mean_elongation(const Corners& rest, const Corners& present) {
  double sum = 0;
  each_elongation(rest, present, [&](double elongation) { sum += elongation; });
  return sum / 6;
}

double max_elongation(const Corners& rest, const Corners& present) {
  double largest = -1;
  each_elongation(rest, present, [&](double elongation) { largest = std::max(largest, elongation); });
  return largest;
}

TearSearch::TearSearch(const ElasticMesh& mesh, TearCriterion criterion, double threshold, int limit)
    : rest_(mesh.rest),
      tetrahedra_(mesh.tetrahedra),
      alive_(mesh.tetrahedra.size(), 1),
      criterion_(criterion),
      threshold_(threshold),
      limit_(limit) {
  if (!(threshold > 0)) throw std::runtime_error("a tearing threshold must be positive");
  if (limit < 1) throw std::runtime_error("a search for torn tetrahedra must be allowed to find one");
  found_.reserve(tetrahedra_.size());
  worst_.reserve(std::min<std::size_t>(limit, tetrahedra_.size()));
}

void TearSearch::remove(std::span<const int> tetrahedra) {
  for (const int t : tetrahedra) alive_[t] = 0;
}

double TearSearch::measure(int tetrahedron, std::span<const Eigen::Vector3d> position) const {
  const auto& nodes = tetrahedra_[tetrahedron];
  return measure_of(criterion_, corners_at(nodes, rest_), corners_at(nodes, position));
}

std::span<const int> TearSearch::find(std::span<const Eigen::Vector3d> position) {
  found_.clear();
  for (int t = 0; t < static_cast<int>(tetrahedra_.size()); ++t) {
    if (!alive_[t]) continue;
    if (const double value = measure(t, position); value > threshold_) found_.push_back({value, t});
  }
  const auto count = std::min<std::ptrdiff_t>(limit_, std::ssize(found_));
  std::partial_sort(found_.begin(), found_.begin() + count, found_.end(), [](const Found& a, const Found& b) {
    return a.measure != b.measure ? a.measure > b.measure : a.tetrahedron < b.tetrahedron;
  });
  worst_.clear();
  for (std::ptrdiff_t i = 0; i < count; ++i) worst_.push_back(found_[i].tetrahedron);
  return worst_;
}

}  // namespace palpate
