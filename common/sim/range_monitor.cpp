#include "common/sim/range_monitor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate {
namespace {

std::string describe(const RangeMonitor::Watched& body) {
  const UsedRange& r = body.now;
  std::string text =
      fmt::format("{} beyond its linear range: stretch {:.0f} %, rotation {:.0f} deg, volume {:+.1f} %", body.name,
                  100 * r.change.stretch, 180 / std::numbers::pi * r.change.rotation, 100 * r.change.volume);
  if (r.force > 0) text += fmt::format(", force {:.0f} % of what is fitted", 100 * r.force);
  return text;
}

void keep_most(const UsedRange& now, UsedRange& most) {
  most.change.stretch = std::max(most.change.stretch, now.change.stretch);
  most.change.rotation = std::max(most.change.rotation, now.change.rotation);
  if (std::abs(now.change.volume) > std::abs(most.change.volume)) most.change.volume = now.change.volume;
  most.force = std::max(most.force, now.force);
}

}  // namespace

bool UsedRange::within() const {
  return change.stretch <= kMaxStretch && change.rotation <= kMaxRotation && std::abs(change.volume) <= kMaxVolume &&
         force <= 1;
}

RangeMonitor::RangeMonitor(const Scene& scene, const Deformer& deformer) {
  for (int b = 0; b < deformer.bodies(); ++b) {
    if (!deformer.shape(b).superposed()) continue;
    const SurfaceMap& map = deformer.map(b);
    watched_.push_back({name_of(scene.bodies[b]), b,
                        SurfaceAtRest(counted_from(deformer.shape(b).origin(), map.position), map.triangles)});
  }
}

std::vector<std::string> RangeMonitor::look(const Deformer& deformer) {
  const bool anew = deformer.run() != run_;
  run_ = deformer.run();
  std::vector<std::string> said;
  for (Watched& body : watched_) {
    body.now = {body.rest.change(deformer.surface(body.body).position), deformer.shape(body.body).used_force()};
    keep_most(body.now, body.most);
    body.said = body.said && !anew;
    if (body.now.within() || body.said) continue;
    body.said = body.left = true;
    said.push_back(describe(body));
  }
  return said;
}

std::string RangeMonitor::warning() const {
  std::string text;
  for (const Watched& body : watched_)
    if (!body.now.within()) text += (text.empty() ? "" : "; ") + describe(body);
  return text;
}

}  // namespace palpate
