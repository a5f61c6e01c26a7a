#include "tools/organ/surface_samples.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "common/geometry/joined_sets.hpp"

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

/// Of many points some that lie far from one another: until none is farther than `near` [m] from these, and of so many
/// at least.
std::vector<SurfaceSample> spread(const std::vector<SurfaceSample>& all, double near, std::size_t least) {
  std::vector<SurfaceSample> chosen;
  const std::size_t stride = 1 + all.size() / kLookedAt, count = (all.size() + stride - 1) / stride;
  std::vector<double> distance(count, std::numeric_limits<double>::infinity());
  for (std::size_t next = 0; chosen.size() < std::min(count, kMaxOfEach);) {
    if (chosen.size() >= least && distance[next] < near * near) break;
    chosen.push_back(all[next * stride]);
    for (std::size_t i = 0; i < count; ++i)
      distance[i] = std::min(distance[i], (all[i * stride].place - chosen.back().place).squaredNorm());
    next = std::ranges::max_element(distance) - distance.begin();
  }
  return chosen;
}

/// Which points lie on one surface: those in cells of `size` [m] that touch. A leader's number for each.
std::vector<int> surface_of(const std::vector<SurfaceSample>& all, const Eigen::Vector3d& low, double size) {
  constexpr int kBits = 20;             // of a cell's number along an axis
  std::unordered_map<long, int> first;  // sample of a cell
  JoinedSets sets(all.size());
  for (int s = 0; s < static_cast<int>(all.size()); ++s) {
    const Eigen::Array3i at = ((all[s].place - low).array() / size).floor().cast<int>() + 1;
    for (int n = 0; n < 27; ++n) {
      const Eigen::Array3i beside = at + Eigen::Array3i(n % 3, n / 3 % 3, n / 9) - 1;
      const long cell = (static_cast<long>(beside[2]) << kBits | beside[1]) << kBits | beside[0];
      if (n == 13) first.try_emplace(cell, s);
      if (const auto other = first.find(cell); other != first.end()) sets.join(s, other->second);
    }
  }
  std::vector<int> surface;
  for (int s = 0; s < static_cast<int>(all.size()); ++s) surface.push_back(sets.leader(s));
  return surface;
}

/// Points between two parts on one surface, most of these first.
std::vector<std::vector<SurfaceSample>> by_parts_and_surface(const std::vector<SurfaceSample>& all,
                                                             const std::vector<int>& surface) {
  std::map<std::array<int, 2>, std::map<int, std::vector<SurfaceSample>>> found;
  for (std::size_t s = 0; s < all.size(); ++s) found[all[s].parts][surface[s]].push_back(all[s]);
  std::vector<std::vector<SurfaceSample>> groups;
  for (auto& [parts, of_surface] : found) {
    const auto first = static_cast<std::ptrdiff_t>(groups.size());
    for (auto& [leader, samples] : of_surface) groups.push_back(std::move(samples));
    std::stable_sort(groups.begin() + first, groups.end(),
                     [](const auto& a, const auto& b) { return a.size() > b.size(); });
  }
  return groups;
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
  std::vector<SurfaceSample> all, samples;
  at_changes(solid, h, [&](const Eigen::Vector3d& a, int part_a, const Eigen::Vector3d& b, int part_b) {
    all.push_back(between(solid, a, part_a, b, part_b));
  });
  const double near = apart * solid.wall.thickness;
  std::array<int, 2> last{-1, -1};
  for (const auto& group : by_parts_and_surface(all, surface_of(all, solid.low, h))) {
    const bool is_first = group.front().parts != last;  // a further surface, of a cavity, needs points an edge apart
    const auto few = is_first ? spread(group, near, kOfEachSurface) : spread(group, std::min(near, step), 0);
    samples.insert(samples.end(), few.begin(), few.end());
    last = group.front().parts;
  }
  return samples;
}

}  // namespace palpate
