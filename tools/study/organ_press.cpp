#include "tools/study/organ_press.hpp"

#include <algorithm>
#include <cmath>

#include "common/tool/instrument.hpp"
#include "tools/study/solid_kinds.hpp"

namespace palpate::study {

OrganPress::OrganPress(const Scene& scene, const Archive& archive, const Patch& patch, double radius, double tick)
    : archive_(archive),
      patch_(patch),
      radius_(radius),
      tick_(tick),
      depth_(-0.05 * radius),
      parts_(tool_parts(scene.tools[0])),
      before_(bytes_in_use()),
      organ_(archive, *as<MovingSpec>(scene.bodies[0]),
             StepSettings{scene.contact, scene.tools, 1 / scene.rates.haptic_hz}, model_maker(scene.bodies[0])),
      bytes_(bytes_in_use() - before_),
      trocar_(make_trocar(scene.tools[0].pivot, scene.tools[0].axis, scene.tools[0].up)) {
  tool_.moving.parts = tool_.moving.parts_before = parts_;
  tool_.present = true;
  tool_.dofs = dofs_for_tip(trocar_, centre_at(patch_, radius_, depth_), 0);
  tool_.moving.now = tool_.moving.before = tip_pose(trocar_, tool_.dofs);
}

double OrganPress::tick(double depth) {
  depth_ = depth;
  tool_.moving.before = tool_.moving.now;
  tool_.dofs = dofs_for_tip(trocar_, centre_at(patch_, radius_, depth), 0);
  tool_.moving.now = tip_pose(trocar_, tool_.dofs);
  organ_.tick({&tool_, 1}, tick_);
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const TouchContact& c : organ_.contacts()) force += c.force;
  if (const HybridTouch* still = organ_.still_part())
    for (std::size_t c = 0; c < still->contacts().size(); ++c) force += still->force(static_cast<int>(c));
  return force.dot(patch_.inward);
}

double OrganPress::settle(double seconds) {
  const auto window = static_cast<int>(0.05 / tick_);
  auto shape = displacement();
  double before = 0;
  for (double t = 0; t < seconds; t += window * tick_) {
    double mean = 0, least = 1e300, most = -1e300;
    for (int i = 0; i < window; ++i) {
      const double force = tick(depth_);
      mean += force / window;
      least = std::min(least, force);
      most = std::max(most, force);
    }
    const auto now = displacement();
    double change = 0, size = 0;
    for (std::size_t n = 0; n < now.size(); ++n)
      change += (now[n] - shape[n]).squaredNorm(), size += now[n].squaredNorm();
    shape = now;
    const bool settled =
        change < 1e-8 * size && most - least < 1e-3 * std::abs(mean) && std::abs(mean - before) < 1e-4 * std::abs(mean);
    before = mean;
    if (settled) break;
  }
  return before;
}

Eigen::Vector3d OrganPress::node_displacement(int node) const {
  const HybridTouch* still = organ_.still_part();
  return still && still->part().owns(node) ? still->part().displacement(node) : organ_.model().displacement(node);
}

std::vector<Eigen::Vector3d> OrganPress::displacement() const {
  std::vector<Eigen::Vector3d> u;
  for (int n = 0; n < archive_.surface.size(); ++n) u.push_back(node_displacement(n));
  return u;
}

double OrganPress::at(const std::array<int, 3>& nodes) const {
  double sum = 0;
  for (const int n : nodes) sum += node_displacement(n).dot(patch_.inward) / 3;
  return sum;
}

}  // namespace palpate::study
