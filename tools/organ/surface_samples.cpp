#include "tools/organ/surface_samples.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace palpate {
namespace {

constexpr int kOfEachSurface = 40;
constexpr int kMaxSteps = 160;  // along an axis: lines are no denser than that

SurfaceSample between(const Solid& solid, Eigen::Vector3d a, int part_a, Eigen::Vector3d b, int part_b) {
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d middle = 0.5 * (a + b);
    const int part = solid.part(middle);
    (part == part_a ? a : b) = middle;
    if (part != part_a) part_b = part;
  }
  return {0.5 * (a + b), {std::min(part_a, part_b), std::max(part_a, part_b)}};
}

/// Of many points a few that lie far from one another.
std::vector<SurfaceSample> spread(const std::vector<SurfaceSample>& all) {
  std::vector<SurfaceSample> chosen;
  std::vector<double> distance(all.size(), std::numeric_limits<double>::infinity());
  std::size_t next = 0;
  while (chosen.size() < std::min<std::size_t>(all.size(), kOfEachSurface)) {
    chosen.push_back(all[next]);
    for (std::size_t i = 0; i < all.size(); ++i)
      distance[i] = std::min(distance[i], (all[i].place - all[next].place).squaredNorm());
    next = std::ranges::max_element(distance) - distance.begin();
  }
  return chosen;
}

}  // namespace

std::vector<SurfaceSample> surface_samples(const Solid& solid, double step) {
  const Eigen::Vector3d size = solid.high - solid.low;
  const double h = std::max(0.5 * step, size.maxCoeff() / kMaxSteps);
  std::map<std::array<int, 2>, std::vector<SurfaceSample>> found;
  const Eigen::Array3i count = (size.array() / h).ceil().cast<int>() + 1;
  const auto place = [&](int i, int j, int k) { return Eigen::Vector3d(solid.low + h * Eigen::Vector3d(i, j, k)); };
  std::vector<int> before(static_cast<std::size_t>(count[0]) * count[1], 0);
  for (int k = 0; k < count[2]; ++k)
    for (int j = 0; j < count[1]; ++j)
      for (int i = 0, left = 0; i < count[0]; ++i) {
        const int part = solid.part(place(i, j, k));
        int& below = before[static_cast<std::size_t>(j) * count[0] + i];
        const auto note = [&](const SurfaceSample& s) { found[s.parts].push_back(s); };
        if (i > 0 && part != left) note(between(solid, place(i, j, k), part, place(i - 1, j, k), left));
        if (k > 0 && part != below) note(between(solid, place(i, j, k), part, place(i, j, k - 1), below));
        left = below = part;
      }
  std::vector<SurfaceSample> samples;
  for (const auto& [parts, all] : found) {
    const auto few = spread(all);
    samples.insert(samples.end(), few.begin(), few.end());
  }
  return samples;
}

}  // namespace palpate
