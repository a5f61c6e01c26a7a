#include "tools/organ/surface_samples.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace palpate {
namespace {

constexpr std::size_t kOfEachSurface = 40, kMaxOfEach = 3000, kLookedAt = 30000;
constexpr double kMaxSteps = 1000;  // along an axis: lines are no denser than that,
constexpr double kMaxPlaces = 4e6;  // nor do they cross in more places

SurfaceSample between(const Solid& solid, Eigen::Vector3d a, int part_a, Eigen::Vector3d b, int part_b) {
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d middle = 0.5 * (a + b);
    const int part = solid.part(middle);
    (part == part_a ? a : b) = middle;
    if (part != part_a) part_b = part;
  }
  return {0.5 * (a + b), {std::min(part_a, part_b), std::max(part_a, part_b)}};
}

/// Of many points some that lie far from one another: until none is farther than `near` [m] from these.
std::vector<SurfaceSample> spread(const std::vector<SurfaceSample>& all, double near) {
  std::vector<SurfaceSample> chosen;
  const std::size_t stride = 1 + all.size() / kLookedAt, count = (all.size() + stride - 1) / stride;
  std::vector<double> distance(count, std::numeric_limits<double>::infinity());
  for (std::size_t next = 0; chosen.size() < std::min(count, kMaxOfEach);) {
    if (chosen.size() >= kOfEachSurface && distance[next] < near * near) break;
    chosen.push_back(all[next * stride]);
    for (std::size_t i = 0; i < count; ++i)
      distance[i] = std::min(distance[i], (all[i * stride].place - chosen.back().place).squaredNorm());
    next = std::ranges::max_element(distance) - distance.begin();
  }
  return chosen;
}

/// Calls note(place, its part, place before it along an axis, that one's part) where the part changes on a grid.
template <class Note>
void at_changes(const Solid& solid, double h, const Note& note) {
  const Eigen::Array3i count = ((solid.high - solid.low).array() / h).ceil().cast<int>() + 1;
  const auto place = [&](int i, int j, int k) { return Eigen::Vector3d(solid.low + h * Eigen::Vector3d(i, j, k)); };
  std::vector<int> below(static_cast<std::size_t>(count[0]) * count[1], 0), before(count[0], 0);
  for (int k = 0; k < count[2]; ++k)
    for (int j = 0; j < count[1]; ++j)
      for (int i = 0, left = 0; i < count[0]; ++i) {
        const int part = solid.part(place(i, j, k));
        int &under = below[static_cast<std::size_t>(j) * count[0] + i], &behind = before[i];
        if (i > 0 && part != left) note(place(i, j, k), part, place(i - 1, j, k), left);
        if (j > 0 && part != behind) note(place(i, j, k), part, place(i, j - 1, k), behind);
        if (k > 0 && part != under) note(place(i, j, k), part, place(i, j, k - 1), under);
        left = behind = under = part;
      }
}

}  // namespace

std::vector<SurfaceSample> surface_samples(const Solid& solid, double step, double apart) {
  const Eigen::Vector3d size = solid.high - solid.low;
  const double finest = std::max(size.maxCoeff() / kMaxSteps, std::cbrt(size.prod() / kMaxPlaces));
  const double h = std::max(0.5 * std::min(step, solid.wall.thickness), finest);
  std::map<std::array<int, 2>, std::vector<SurfaceSample>> found;
  at_changes(solid, h, [&](const Eigen::Vector3d& a, int part_a, const Eigen::Vector3d& b, int part_b) {
    const SurfaceSample sample = between(solid, a, part_a, b, part_b);
    found[sample.parts].push_back(sample);
  });
  std::vector<SurfaceSample> samples;
  for (const auto& [parts, all] : found) {
    const auto few = spread(all, apart * solid.wall.thickness);
    samples.insert(samples.end(), few.begin(), few.end());
  }
  return samples;
}

}  // namespace palpate
