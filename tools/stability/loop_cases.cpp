// The closed loop: a hand on a device against a wall and tissue.
//
// Hand: M = 0.554 kg, B = 6.45 N s/m, K = 135 N/m, measured on a HapticMaster (van Beek et al., "Haptic perception of
// force magnitude and its relation to postural arm dynamics in 3D", Scientific Reports 5:18004, 2015, fig. 3). Device:
// its mass is in the hand's; its own damping is taken as nothing. Passivity of a sampled wall: b > K T/2 + B (J. E.
// Colgate and G. Schenkel, "Passivity of a class of sampled-data systems", J. Robotic Systems 14(1), 1997); with a
// delay t_d: K < (b + B)/(T/2 + t_d) for small B (T. Hulin, A. Albu-Schaeffer and G. Hirzinger, "Passivity and
// stability boundaries for haptic systems with time delay", IEEE Trans. Control Systems Technology 22(4), 2014). Here
// the hand's own damping stands for b and B is 0.
#include <fmt/format.h>

#include <cmath>
#include <deque>
#include <optional>
#include <random>

#include "tools/rig/example_bodies.hpp"
#include "tools/rig/kinds.hpp"
#include "tools/stability/watch.hpp"

namespace palpate::stability {
namespace {

using Eigen::Vector3d;

/// Along the press alone.
struct Hand {
  double mass = 0.554, damping = 6.45, stiffness = 135;
  double at = 0, speed = 0;

  void move(double intended, double force, double dt) {
    constexpr int parts = 20;
    for (int i = 0; i < parts; ++i) {
      speed += (stiffness * (intended - at) - damping * speed + force) / mass * dt / parts;
      at += speed * dt / parts;
    }
  }
};

struct Link {
  double rate = 1000;  ///< [Hz]
  int delay = 0;       ///< [ticks] of the wall's answer
  double jitter = 0;   ///< [ticks] more, at random
  double loss = 0;     ///< share of answers that are lost
  double quantum = 0;  ///< [m] of the sensed place
  double slew = 1e5;   ///< [N/s] at which the force rises
  bool local = false;  ///< the answer carries the stiffness, as a local contact model does
  bool controller = true;
};

struct LoopEnd {
  Result result;
  double swing = 0, before = 0;  ///< [m] in the last half second; in half a second a second before
  double last = 0;               ///< [m] where it is at the end
};

double quantised(double x, double quantum) {
  return quantum > 0 ? quantum * std::round(x / quantum) : x;
}

/// How far the tip still goes to and fro once it should have settled.
class Swing {
 public:
  void add(double time, double at) {
    if (time >= 1.5 && time < 2) early_.add(at);
    if (time >= 2.5) late_.add(at);
    last_ = at;
  }
  double late() const { return late_.size(); }    ///< [m] in the last half second
  double early() const { return early_.size(); }  ///< [m] a second before
  double last() const { return last_; }           ///< [m]

 private:
  struct Range {
    void add(double at) {
      low = std::min(low, at);
      high = std::max(high, at);
    }
    double size() const { return high > low ? high - low : 0; }
    double low = 1e9, high = -1e9;
  };
  Range early_, late_;
  double last_ = 0;
};

constexpr double kTipRadius = 0.008, kPush = 0.01;

Scene wall_scene(const Link& link) {
  Scene scene = block_scene();
  scene.bodies[0] = as_kind<TensorMassSpec>(block_of(scene));
  scene.contact.friction = 0;
  scene.rates.haptic_hz = link.rate;
  scene.passivity.controller = link.controller;
  scene.tools[0].max_force = 20;
  scene.tools[0].max_force_rate = link.slew;
  return scene;
}

/// A wall z = 0 of `stiffness` [N/m] that is worked out elsewhere: its force comes late, through the haptic step's own
/// local contact model. Three seconds; the hand wants to be 10 mm inside.
LoopEnd touch_wall(double stiffness, const Link& link) {
  const Scene scene = wall_scene(link);
  const Tool& tool = scene.tools[0];
  HapticStep haptic(scene, std::vector<Archive>(1));
  const double dt = haptic.dt();
  Hand hand{.at = 0.002};
  const auto dofs_of = [&](double at) { return tip_at(tool, {0, 0, kTipRadius + quantised(at, link.quantum)}); };
  haptic.start(std::array{dofs_of(hand.at)});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(0, 1);
  std::deque<std::pair<std::uint64_t, LocalContactModel>> late;
  Watch watch;
  Swing swing;
  std::uint64_t newest = 0;
  const auto steps = static_cast<std::uint64_t>(3 / dt);
  for (std::uint64_t i = 0; i < steps; ++i) {
    hand.move(-kPush, i > 0 ? haptic.force(0).z() : 0, dt);
    const ToolDofs dofs = dofs_of(hand.at);
    const double depth = -quantised(hand.at, link.quantum);
    LocalContactModel m;
    m.run = 1, m.seq = i + 1, m.tool_run = 1, m.tool_step = i;
    m.yaw = dofs.yaw, m.pitch = dofs.pitch, m.depth = dofs.depth, m.roll = dofs.roll, m.grip = dofs.grip;
    const double k = link.local ? stiffness : 0;
    if (depth > 0)
      m.contacts.push_back({0, 0, {0, 0, -depth}, {0, 0, -1}, {0, 0, -stiffness * depth}, {k, 0, 0, 0, k, 0, 0, 0, k}});
    if (any(random) >= link.loss)
      late.emplace_back(i + link.delay + static_cast<std::uint64_t>(link.jitter * any(random)), m);
    for (auto& [due, model] : late)
      if (due <= i && model.seq > newest) {
        newest = model.seq;
        haptic.consume(model);
      }
    while (!late.empty() && late.front().first <= i) late.pop_front();
    haptic.step(std::array{dofs});
    watch.look(haptic);
    swing.add(static_cast<double>(i) * dt, hand.at);
  }
  return {watch.result(scene.passivity.reserve), swing.late(), swing.early(), swing.last()};
}

/// At rest or on its way there, and held by the wall: not more than 3 mm deeper than the springs of hand and wall have
/// it.
bool settles(double stiffness, const Link& link) {
  const LoopEnd end = touch_wall(stiffness, link);
  const double rest = kPush * Hand{}.stiffness / (Hand{}.stiffness + stiffness);
  return (end.swing < 1e-4 + 3 * link.quantum || end.swing < 0.9 * end.before) && -end.last < rest + 0.003;
}

double bound_of(const Link& link) {
  return Hand{}.damping / (0.5 / link.rate + (link.delay + link.jitter) / link.rate);
}

/// The largest stiffness at which the hand comes to rest, by bisection of its logarithm.
Result max_stiffness(const Link& link) {
  double low = 10, high = 1e6;
  if (settles(high, link)) low = high;
  for (int i = 0; i < 14 && high / low > 1.02; ++i) {
    const double middle = std::sqrt(low * high);
    (settles(middle, link) ? low : high) = middle;
  }
  const double bound = bound_of(link);
  const LoopEnd beyond = touch_wall(std::min(3 * low, 1e6), link);
  Result r = beyond.result;
  r.note = fmt::format("K_max={:.4g} N/m{}, bound={:.4g} N/m; at {} it swings by {:.3g} mm, {:.3g} mm inside{}{}", low,
                       low < 1e6 ? "" : " at least", bound, 3 * low < 1e6 ? "three times K_max" : "1e6 N/m",
                       1e3 * beyond.swing, -1e3 * beyond.last, r.note.empty() ? "" : ", ", r.note);
  return r;
}

/// What the deformation node says of the tissue after a tick.
std::optional<LocalContactModel> model_of(PressRig& rig, std::uint64_t tick) {
  LocalContactModel m;
  rig.simulator().local_models().refresh();
  if (!rig.simulator().local_models().describe(0, m)) return {};
  m.run = 1, m.seq = tick + 1;
  return m;
}

/// Tissue of the deformation node under the hand, its local contact models `delay` ticks late.
LoopEnd touch_tissue(int delay, bool controller) {
  Scene scene = moving_block_scene();
  scene.passivity.controller = controller;
  scene.contact.friction = 0;
  PressRig rig(scene, {precompute_on(scene.bodies[0], small_block_mesh())});
  HapticStep& haptic = rig.haptic();
  Hand hand{.at = 0.002};
  const auto dofs_of = [&] { return std::array{tip_at(scene.tools[0], {0, 0, 0.026 + hand.at})}; };
  rig.start(dofs_of());
  std::deque<std::pair<std::uint64_t, LocalContactModel>> late;
  Watch watch;
  Swing swing;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    hand.move(-0.006, i > 0 ? haptic.force(0).z() : 0, 1e-3);
    const auto dofs = dofs_of();
    rig.press(dofs);
    if (const auto m = model_of(rig, i)) late.emplace_back(i + delay, *m);
    while (!late.empty() && late.front().first <= i) {
      haptic.consume(late.front().second);
      late.pop_front();
    }
    haptic.step(dofs);
    watch.look(haptic);
    swing.add(1e-3 * static_cast<double>(i), hand.at);
  }
  return {watch.result(scene.passivity.reserve), swing.late(), swing.early(), swing.last()};
}

/// The block of quasi-static tissue, its stiffness by its Young's modulus.
LoopEnd touch_block(double young, double rate, bool controller) {
  Scene scene = block_scene();
  block_of(scene).material.young = young;
  scene.rates.haptic_hz = rate;
  scene.passivity.controller = controller;
  scene.tools[0].max_force = 20;
  scene.tools[0].max_force_rate = 1e5;
  PressRig rig(scene, {precompute(block_of(scene), block_mesh())});
  Hand hand{.at = 0.002};
  const auto tip = [&] { return Eigen::Vector3d(0, 0, kTipRadius + hand.at); };
  rig.start(tip());
  Watch watch;
  Swing swing;
  for (int i = 0; i < 3 * rate; ++i) {
    hand.move(-kPush, i > 0 ? rig.haptic().force(0).z() : 0, 1 / rate);
    rig.step(tip());
    watch.look(rig.haptic());
    swing.add(i / rate, hand.at);
  }
  return {watch.result(scene.passivity.reserve), swing.late(), swing.early(), swing.last()};
}

Result told(LoopEnd end) {
  end.result.note = fmt::format("swings by {:.3g} mm, {:.3g} mm inside{}{}", 1e3 * end.swing, -1e3 * end.last,
                                end.result.note.empty() ? "" : ", ", end.result.note);
  return end.result;
}

}  // namespace

std::vector<Point> loop_points(const Extent& extent) {
  std::vector<Point> points;
  for (const bool controller : {true, false}) {
    const char* with = controller ? "controller" : "observer only";
    const auto wall = [&](const char* parameter, const std::string& value, Link link) {
      link.controller = controller;
      points.push_back({fmt::format("loop {}", with), parameter, value, [link] { return max_stiffness(link); }, 300});
    };
    for (int d : extent.quick ? std::vector{0, 20} : std::vector{0, 1, 2, 5, 10, 20, 50, 100})
      wall("delay [ms]", std::to_string(d), {.delay = d});
    for (int d : extent.quick ? std::vector{20} : std::vector{5, 20, 50, 100})
      wall("delay [ms], with local stiffness", std::to_string(d), {.delay = d, .local = true});
    for (double r : extent.quick ? std::vector<double>{} : std::vector{100.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0})
      wall("rate [Hz]", fmt::format("{:g}", r), {.rate = r});
    for (double q : extent.quick ? std::vector{1e-4} : std::vector{1e-6, 1e-5, 1e-4, 1e-3})
      wall("quantisation [m]", fmt::format("{:g}", q), {.quantum = q});
    for (double j : extent.quick ? std::vector<double>{} : std::vector{5.0, 20.0})
      wall("jitter [ms] after 10 ms", fmt::format("{:g}", j), {.delay = 10, .jitter = j});
    for (double l : extent.quick ? std::vector<double>{} : std::vector{0.05, 0.3})
      wall("loss [1] after 10 ms", fmt::format("{:g}", l), {.delay = 10, .loss = l});
    for (int d : extent.quick ? std::vector{50} : std::vector{0, 5, 20, 50, 100}) {
      points.push_back({fmt::format("wall of 2000 N/m, {}", with), "delay [ms]", std::to_string(d),
                        [=] { return told(touch_wall(2000, {.delay = d, .controller = controller})); }});
      if (!extent.quick || d > 0)
        points.push_back({fmt::format("wall of 2000 N/m, {}", with), "delay [ms], slew limit 250 N/s",
                          std::to_string(d),
                          [=] { return told(touch_wall(2000, {.delay = d, .slew = 250, .controller = controller})); }});
      points.push_back({fmt::format("moving tissue, {}", with), "delay [ms]", std::to_string(d),
                        [=] { return told(touch_tissue(d, controller)); }, 120});
    }
    for (double e : extent.quick ? std::vector{5e3, 1e9} : std::vector{1.0, 5e3, 1e5, 1e6, 1e7, 1e9})
      points.push_back({fmt::format("still tissue, {}", with), "E [Pa]", fmt::format("{:g}", e),
                        [=] { return told(touch_block(e, 1000, controller)); }});
  }
  return points;
}

}  // namespace palpate::stability
