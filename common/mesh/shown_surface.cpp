#include "common/mesh/shown_surface.hpp"

#include <algorithm>
#include <set>

namespace palpate {
namespace {

std::array<int, 3> sorted(std::array<int, 3> t) {
  std::sort(t.begin(), t.end());
  return t;
}

}  // namespace

ShownSurface::ShownSurface(std::span<const std::array<int, 3>> surface, const CutMesh& part)
    : is_joint_(4 * part.size(), 0) {
  std::set<std::array<int, 3>> seen, of_part;
  for (const auto& t : surface) seen.insert(sorted(t));
  for (int facet : part.visible()) {
    of_part.insert(sorted(part.facet(facet)));
    if (seen.contains(sorted(part.facet(facet)))) continue;
    is_joint_[facet] = 1;
    joints_.push_back(facet);
  }
  std::sort(joints_.begin(), joints_.end());
  for (const auto& t : surface)
    if (!of_part.contains(sorted(t))) of_rest_.push_back(t);
}

const std::vector<std::array<int, 3>>& ShownSurface::triangles(const CutMesh& part) {
  triangles_ = of_rest_;
  for (int facet : part.visible())
    if (!is_joint_[facet]) triangles_.push_back(part.facet(facet));
  for (int facet : joints_) {
    if (part.alive(facet / 4)) continue;
    const auto [a, b, c] = part.facet(facet);
    triangles_.push_back({a, c, b});
  }
  return triangles_;
}

}  // namespace palpate
