#include "common/tool/grip.hpp"

#include <cmath>
#include <numbers>

#include "common/tool/jaws.hpp"

namespace palpate {
namespace {

constexpr double kNearestGrip = 1e-3;  // [m] from J: what is held nearer bears no more force than there
constexpr double kTouchSlack = 1e-9;   // [rad] within which the jaws count as being at the touch

/// Half openings at which jaw A and jaw B touch a ball; 0 where a jaw does not meet it.
struct JawTouch {
  double a = 0, b = 0;
};

JawTouch jaw_touch(const ForcepsShape& shape, const Eigen::Vector3d& p, double radius) {
  const double reach = shape.jaw_radius + radius, from_joint = std::hypot(p.y(), p.z());
  if (std::abs(p.x()) >= reach || p.z() <= 0) return {};
  const double across =
      std::sqrt(reach * reach - p.x() * p.x());  // of jaw and ball, in the plane in which the jaws turn
  const double along = std::sqrt(std::max(0.0, from_joint * from_joint - across * across));
  if (along > shape.jaw_length) return {};
  const double half = across < from_joint ? std::asin(across / from_joint) : 0.5 * std::numbers::pi,
               middle = std::atan2(p.y(), p.z());
  const auto within = [](double angle) { return std::clamp(angle, 0.0, 0.5 * std::numbers::pi); };
  return {within(half + middle), within(half - middle)};
}

}  // namespace

double opening_at_contact(const ForcepsShape& shape, const Eigen::Vector3d& p, double radius) {
  const JawTouch touch = jaw_touch(shape, p, radius);
  return 2 * std::min(touch.a, touch.b);
}

double opening_at_contact(const ForcepsShape& shape, const Segment& segment, double radius) {
  // Points a quarter of jaw and segment apart, and the one that passes through the plane in which the jaws turn.
  const double reach = shape.jaw_radius + radius;
  const int pieces = 1 + static_cast<int>(4 * segment.length() / reach);
  double largest = 0;
  for (int i = 0; i <= pieces; ++i)
    largest = std::max(largest, opening_at_contact(shape, segment.at(static_cast<double>(i) / pieces), radius));
  const double a = segment.start.x(), b = segment.end.x();
  return a * b < 0 ? std::max(largest, opening_at_contact(shape, segment.at(a / (a - b)), radius)) : largest;
}

double opening_at_contact(const ForcepsShape& shape, std::span<const GripObstacle> obstacles, double opening) {
  JawTouch largest;
  for (const GripObstacle& o : obstacles) {
    if (std::abs(std::atan2(o.position.y(), o.position.z())) > 0.5 * opening) continue;
    const JawTouch touch = jaw_touch(shape, o.position, o.radius);
    largest.a = std::max(largest.a, touch.a);
    largest.b = std::max(largest.b, touch.b);
  }
  return 2 * std::min(largest.a, largest.b);
}

Grip grip_at(const GripLaw& law, double commanded) {
  const double wanted = std::isfinite(commanded) ? std::clamp(commanded, 0.0, law.max_open) : 0.0;
  return {.opening = wanted, .commanded = wanted};
}

GripEvent work_grip(Grip& grip, const GripLaw& law, double commanded, double touch, double distance, double load,
                    double dt) {
  if (std::isfinite(commanded)) grip.commanded = std::clamp(commanded, 0.0, law.max_open);
  const double bound = grip_capacity(grip, law), most = law.rate * dt;
  grip.touch = std::min(touch, law.max_open);
  grip.distance = touch > 0 ? distance : 0.0;
  const double wanted = std::max(grip.commanded, grip.touch);
  grip.opening += std::clamp(wanted - grip.opening, -most, most);
  grip.stopped = touch > 0 && grip.commanded <= grip.touch && grip.opening <= grip.touch + kTouchSlack;
  const bool open = touch <= 0 || grip.commanded > grip.touch + kJawSlack;  // past the touch, or there is none
  grip.slipped = grip.slipped && !open;
  if (!grip.holding) {
    grip.holding = !grip.slipped && grip_force(grip, law) >= kMinGripForce;
    return grip.holding ? GripEvent::taken : GripEvent::none;
  }
  if (!open && !(load > bound)) return GripEvent::none;
  grip.holding = false;
  grip.slipped = !open;
  return open ? GripEvent::released : GripEvent::dropped;
}

double grip_torque(const Grip& grip, const GripLaw& law) {
  return grip.stopped ? law.stiffness * std::max(0.0, grip.opening - grip.commanded) : 0.0;
}

double grip_force(const Grip& grip, const GripLaw& law) {
  return grip_torque(grip, law) / std::max(grip.distance, kNearestGrip);
}

double grip_capacity(const Grip& grip, const GripLaw& law) {
  return 2 * law.friction * grip_force(grip, law);
}

}  // namespace palpate
