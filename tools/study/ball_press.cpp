#include "tools/study/ball_press.hpp"

#include <algorithm>
#include <cmath>

#include "tools/study/kinds.hpp"
#include "tools/study/measure.hpp"

namespace palpate::study {
namespace {

template <class Make>
std::size_t bytes_of(Make&& make) {
  const std::size_t before = bytes_in_use();
  const auto made = make();
  return bytes_in_use() - before;
}

}  // namespace

Scene ball_scene(const Scene& from, Body body, const Patch& patch, double radius) {
  Scene scene;
  scene.file = from.file;
  scene.bodies = {std::move(body)};
  scene.contact = from.contact;
  scene.contact.friction = 0;
  scene.rates = from.rates;
  scene.passivity.controller = false;
  Tool ball;
  ball.name = "ball";
  ball.axis = patch.inward;
  ball.up = patch.inward.unitOrthogonal();
  std::get<ProbeSpec>(ball.end).radius = radius;
  ball.shaft_radius = 0.3 * radius;
  ball.shaft_length = 0.4 * radius;
  ball.pivot = patch.point - 0.3 * patch.inward;
  ball.max_force = 1e9;
  ball.max_force_rate = 1e15;
  scene.tools = {ball};
  return scene;
}

BallPress::BallPress(const Scene& scene, const Archive& archive, const Patch& patch, double radius)
    : rig_(scene, {archive}),
      patch_(patch),
      trocar_(make_trocar(scene.tools[0].pivot, scene.tools[0].axis, scene.tools[0].up)),
      radius_(radius),
      depth_(-0.05 * radius) {
  rig_.start(at(depth_));
}

std::array<ToolDofs, 1> BallPress::at(double depth) const {
  return {dofs_for_tip(trocar_, centre_at(patch_, radius_, depth), 0)};
}

double BallPress::step(double depth) {
  depth_ = depth;
  rig_.press(at(depth));
  return rig_.force().dot(patch_.inward);
}

double BallPress::bring(double depth, int ticks) {
  const double begin = depth_;
  double force = 0;
  for (int i = 1; i <= ticks; ++i) force = step(begin + (depth - begin) * i / ticks);
  return force;
}

PressAnswer BallPress::to(double depth, int settling) {
  PressAnswer answer;
  answer.force = bring(depth, 1 + static_cast<int>(std::abs(depth - depth_) / (0.01 * radius_)));
  for (int i = 0; i < settling; ++i) answer.force = step(depth);
  answer.displacement = displacement();
  return answer;
}

double BallPress::settle(double seconds) {
  const auto window = static_cast<int>(0.05 / rig_.dt());
  auto shape = displacement();
  double before = 0;
  for (double t = 0; t < seconds; t += window * rig_.dt()) {
    double mean = 0, least = 1e300, most = -1e300;
    for (int i = 0; i < window; ++i) {
      const double force = step(depth_);
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

std::vector<double> BallPress::time(int warm_up, int count) {
  const double middle = depth_;
  auto seconds = time_steps(warm_up, count, [&](int i) { step(middle + 1e-3 * radius_ * std::sin(0.05 * i)); });
  step(middle);
  return seconds;
}

double BallPress::along(const std::vector<Eigen::Vector3d>& u, const std::array<int, 3>& nodes) const {
  double sum = 0;
  for (const int n : nodes) sum += u[n].dot(patch_.inward) / 3;
  return sum;
}

std::size_t owner_bytes(const Scene& scene, const Archive& archive) {
  const std::vector<Archive> archives{archive};
  return std::visit([&](const auto& spec) { return owner_bytes(spec, scene, archives); }, scene.bodies[0]);
}

std::size_t owner_bytes(const NamedSpec&, const Scene& scene, const std::vector<Archive>& archives) {
  struct Owner {
    HapticStep step;
    Deformer deformer;
  };
  return bytes_of([&] { return Owner{.step{scene, archives}, .deformer{scene, archives}}; });
}

std::size_t owner_bytes(const MovingSpec& spec, const Scene& scene, const std::vector<Archive>& archives) {
  const StepSettings settings{scene.contact, scene.tools, 1 / scene.rates.haptic_hz};
  const auto make = [&](const ElasticMesh& mesh) { return make_model(scene.bodies[0], mesh); };
  return bytes_of([&] { return DynamicOrgan(archives[0], spec, settings, make); });
}

}  // namespace palpate::study
