#include "tools/study/haptic_press.hpp"

#include <cmath>

namespace palpate::study {

HapticPress::HapticPress(Scene scene, const std::vector<Archive>& archives, const Patch& patch, double radius)
    : scene_(std::move(scene)),
      patch_(patch),
      radius_(radius),
      depth_(-0.05 * radius),
      before_(bytes_in_use()),
      haptic_(scene_, archives),
      deformer_(scene_, archives),
      bytes_(bytes_in_use() - before_),
      trocar_(make_trocar(scene_.tools[0].pivot, scene_.tools[0].axis, scene_.tools[0].up)) {
  haptic_.start(std::array{dofs_for_tip(trocar_, centre_at(patch_, radius_, depth_), 0)});
}

double HapticPress::step(double depth) {
  depth_ = depth;
  haptic_.step(std::array{dofs_for_tip(trocar_, centre_at(patch_, radius_, depth), 0)});
  ++count_;
  return -haptic_.force(0).dot(patch_.inward);
}

PressAnswer HapticPress::to(double depth, int settling) {
  const double begin = depth_;
  const int steps = 1 + static_cast<int>(std::abs(depth - begin) / (0.01 * radius_));
  for (int i = 1; i <= steps; ++i) step(begin + (depth - begin) * i / steps);
  PressAnswer answer;
  for (int i = 0; i < settling; ++i) answer.force = step(depth);
  answer.displacement = shown();
  return answer;
}

std::vector<double> HapticPress::time(int count) {
  const double middle = depth_;
  auto seconds = time_steps(200, count, [&](int i) { step(middle + 1e-3 * radius_ * std::sin(0.05 * i)); });
  step(middle);
  return seconds;
}

ContactState HapticPress::contacts() const {
  ContactState m;
  m.run = 1;
  m.seq = m.step = count_;
  m.sense_ns = static_cast<std::int64_t>(count_);
  Eigen::Map<Eigen::Vector3d>(m.press.data()) = haptic_.press(0);
  for (const TouchContact& c : haptic_.law(0).contacts()) {
    if (c.touch == Touch::open) continue;
    HeldContact held;
    for (int v = 0; v < 3; ++v) held.nodes[v] = static_cast<std::uint32_t>(c.anchor.nodes[v]);
    Eigen::Map<Eigen::Vector3d>(held.weights.data()) = c.anchor.weights;
    Eigen::Map<Eigen::Vector3d>(held.normal.data()) = c.normal;
    Eigen::Map<Eigen::Vector3d>(held.force.data()) = c.force;
    m.contacts.push_back(held);
  }
  haptic_.law(0).for_each_nodal_force([&](int, int node, const Eigen::Vector3d& f) {
    m.forces.push_back({0, static_cast<std::uint32_t>(node), {f[0], f[1], f[2]}});
  });
  return m;
}

std::vector<Eigen::Vector3d> HapticPress::shown() {
  deformer_.take(contacts());
  for (BodyNews& news : haptic_.news()) {
    std::visit(
        [&](auto& m) {
          m.run = 1;
          m.seq = m.step = count_;
          m.sense_ns = static_cast<std::int64_t>(count_);
        },
        news.message);
    haptic_.tell(news.message);
    deformer_.take(news.message);
  }
  deformer_.deform();
  std::vector<Eigen::Vector3d> u;
  for (const Eigen::Vector3f& d : deformer_.surface(0).displacement) u.push_back(d.cast<double>());
  return u;
}

}  // namespace palpate::study
