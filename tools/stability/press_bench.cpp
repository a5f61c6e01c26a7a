#include "tools/stability/press_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/study/solid_kinds.hpp"

namespace palpate::stability {

void Watch::look(const HapticStep& haptic) {
  ++steps_;
  std::uint32_t flags = 0;
  for (int t = 0; t < haptic.tools(); ++t) {
    flags |= haptic.flags(t);
    torque_ = larger(torque_, haptic.torque(t).norm());
    finite_ &= std::isfinite(haptic.grip_torque(t));
    largest_ = larger(largest_, haptic.force(t).norm());
  }
  max_lost_ = larger(max_lost_, -haptic.energy());
  regularised_ += (flags & regularised) != 0;
  limited_ += (flags & force_limited) != 0;
  slewed_ += (flags & slew_limited) != 0;
  faults_ += (flags & fault) != 0;
  stale_ += (flags & stale_model) != 0;
  damped_ += (flags & passivity_limited) != 0;
}

Result Watch::result() const {
  Result r{.max_force = largest_, .energy_growth = max_lost_, .note = {}};
  const auto say = [&](int count, const char* what) {
    if (count == 0) return;
    r.outcome = Outcome::regularised;
    r.note += fmt::format("{}{} in {} of {} steps", r.note.empty() ? "" : ", ", what, count, steps_);
  };
  say(regularised_, "contacts softened");
  say(limited_, "force limited");
  say(slewed_, "slew limited");
  say(damped_, "damped for passivity");
  say(stale_, "faded for want of a model");
  say(faults_, "fault, force ramped to zero,");
  if (torque_ > kMaxTorque) {
    r.outcome = Outcome::failed;
    r.note += fmt::format("{}torque up to {:.3g} N m", r.note.empty() ? "" : ", ", torque_);
  }
  if (!finite_ || !std::isfinite(torque_))
    r = {.outcome = Outcome::failed, .note = "a force is not a number; " + r.note};
  return r;
}

Scene block_scene(double scale) {
  Scene scene;
  QuasiStaticSpec body;
  body.name = "block";
  body.material = {.young = 5000, .poisson = 0.4, .density = 1000};
  body.fixed.push_back({.where = {.indices = {}, .box = {}, .group = "bottom"}});
  scene.bodies.push_back(body);
  Tool tool;
  tool.name = "probe";
  tool.pivot = {0, 0, 0.2 * scale};
  tool.probe()->radius = 0.008 * scale;
  tool.shaft_radius = 0.0025 * scale;
  tool.shaft_length = 0.3 * scale;
  scene.tools.push_back(tool);
  return scene;
}

void make_moving(Scene& scene) {
  scene.bodies[0] = as_kind<TensorMassSpec>(block_of(scene));
}

TetMesh block_mesh(double scale, int cells) {
  return make_block(scale * Eigen::Vector3d(-0.05, -0.05, -0.05), scale * Eigen::Vector3d(0.05, 0.05, 0),
                    {cells, cells, cells / 2});
}

ToolDofs tip_at(const Tool& tool, const Eigen::Vector3d& p, double roll) {
  return dofs_for_tip(make_trocar(tool.pivot, tool.axis, tool.up), p, roll);
}

Result press(const Scene& scene, const TetMesh& mesh, const std::function<Eigen::Vector3d(int)>& path, int steps) {
  std::vector<Archive> archives;
  for (const Body& body : scene.bodies) archives.push_back(precompute(*as<QuasiStaticSpec>(body), mesh));
  HapticStep haptic(scene, archives);
  const Tool& tool = scene.tools[0];
  haptic.start(std::array{tip_at(tool, path(0))});
  Watch watch;
  for (int i = 1; i <= steps; ++i) {
    haptic.step(std::array{tip_at(tool, path(i))});
    watch.look(haptic);
  }
  return watch.result();
}

std::function<Eigen::Vector3d(int)> down_and_up(double above, double depth, int ticks) {
  return [=](int i) {
    const double share = i < ticks ? 1.0 * i / ticks : i < 2 * ticks ? 1.0 : std::max(0.0, 3.0 - 1.0 * i / ticks);
    return Eigen::Vector3d(0, 0, above - share * (above + depth));
  };
}

}  // namespace palpate::stability
