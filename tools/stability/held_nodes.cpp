#include "tools/stability/held_nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "common/contact/held_points.hpp"

namespace palpate::stability {
namespace {

using Eigen::Vector3d;

std::vector<int> free_nodes(const SurfaceMap& surface) {
  std::vector<int> nodes;
  for (int n = 0; n < surface.touchable; ++n)
    if (std::ranges::none_of(surface.fixed[n], [](bool f) { return f; })) nodes.push_back(n);
  return nodes;
}

int node_of(const std::vector<int>& free, const std::string& how, int i, int count) {
  if (how == "spread") return free[static_cast<std::size_t>(i) * free.size() / count];
  return how == "collinear" ? free[i % std::min<std::size_t>(9, free.size())] : free[0];
}

}  // namespace

Result hold_nodes(const Archive& archive, const std::string& how, int count, double press, int most) {
  const SurfaceMap& surface = archive.surface;
  const std::vector<int> free = free_nodes(surface);
  if (count > most) throw std::runtime_error(fmt::format("a haptic step holds at most {} contacts of a body", most));
  if (how == "spread" && count > static_cast<int>(free.size()))
    throw std::runtime_error(fmt::format("the body has {} free touchable nodes", free.size()));
  const Vector3d middle =
      std::accumulate(surface.position.begin(), surface.position.end(), Vector3d(0, 0, 0)) / surface.size();
  const Compliance<double> compliance(archive, Compliance<double>::Rows::touchable);
  const CompliantResponse response(compliance);
  HeldPoints held(response, count);
  std::vector<Vector3d> target;
  for (int i = 0; i < count; ++i) {
    const int node = node_of(free, how, i, count);
    const double shift = how == "adjacent" ? 1e-9 * i : 0;
    Anchor anchor;
    anchor.nodes = {node, (node + 1) % surface.touchable, node};
    anchor.weights = Vector3d(1 - shift, shift, 0);
    held.add(anchor);
    target.push_back(press * (middle - surface.position[node]).normalized() *
                     (how == "contradictory" && i % 2 ? -1 : 1));
  }
  std::vector<double> forces(3 * target.size(), 0.0), moved(forces.size());
  const int raised =
      held.solve(std::vector(count, Hold::all), std::vector<Vector3d>(count, Vector3d::UnitZ()), target, forces.data());
  held.displacements(forces.data(), moved.data());
  double miss = 0;
  Result r{.outcome = raised > 0 ? Outcome::regularised : Outcome::stable, .note = {}};
  for (const double f : forces) r.max_force = larger(r.max_force, std::abs(f));
  for (int i = 0; i < count; ++i)
    miss = larger(miss, (Eigen::Map<const Vector3d>(moved.data() + 3 * i) - target[i]).norm());
  r.note = fmt::format("{} pivots raised, a point misses its place by {:.2g} of the press at most; force is a point's",
                       raised, miss / press);
  return r;
}

}  // namespace palpate::stability
