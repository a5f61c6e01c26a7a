// A scene's own bodies and tools at the edge.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "common/scene/ensure_archive.hpp"
#include "common/sim/local_models.hpp"
#include "haptic_node/device.hpp"
#include "tools/stability/held_nodes.hpp"
#include "tools/stability/press_bench.hpp"
#include "tools/stability/wait_for_workers.hpp"
#include "tools/study/solid_kinds.hpp"

namespace palpate::stability {
namespace {

/// How a scene's own scripted motion is bent.
struct Bend {
  double speed = 1;   ///< times as fast
  double deeper = 0;  ///< [m] further along the shaft, once the motion has begun
  bool controller = true;
  int delay = 1;  ///< [ticks] of the moving tissue's answers
};

/// Haptic step and moving tissue side by side, as the nodes run them, without a clock.
Result play(const Scene& scene, const std::vector<Archive>& archives, const Bend& bend) {
  HapticStep haptic(scene, archives);
  std::unique_ptr<DynamicWorld> world;
  std::unique_ptr<LocalModels> models;
  if (haptic.has_moving_tissue()) {
    world = std::make_unique<DynamicWorld>(scene, archives);
    models = std::make_unique<LocalModels>(*world, archives);
  }
  std::vector<std::unique_ptr<Device>> devices;
  for (int t = 0; t < haptic.tools(); ++t) {
    if (!std::holds_alternative<ScriptedDeviceSpec>(scene.tools[t].device))
      throw std::runtime_error(fmt::format("tool '{}' is not scripted", scene.tools[t].name));
    devices.push_back(make_device(scene, t));
  }
  std::vector<ToolDofs> dofs(devices.size());
  const auto read = [&](std::uint64_t i) {
    const double time = static_cast<double>(i) * haptic.dt() * bend.speed;
    bool finished = true;
    for (std::size_t t = 0; t < devices.size(); ++t) {
      dofs[t] = devices[t]->read(time).dofs;
      dofs[t].depth += bend.deeper * std::min(1.0, time);
      finished &= devices[t]->finished(time);
    }
    return !finished;
  };
  read(0);
  haptic.start(dofs);
  Watch watch;
  std::vector<LocalContactModel> waiting;
  for (std::uint64_t i = 0; i < 60000 && read(i); ++i) {
    for (const LocalContactModel& m : waiting) haptic.consume(m);
    waiting.clear();
    haptic.step(dofs);
    watch.look(haptic);
    if (!world) continue;
    for (std::size_t t = 0; t < dofs.size(); ++t) {
      const ToolDofs& d = dofs[t];
      ToolState s{.tool = static_cast<std::uint32_t>(t),
                  .run = 1,
                  .step = i,
                  .sense_ns = static_cast<std::int64_t>(i),
                  .yaw = d.yaw,
                  .pitch = d.pitch,
                  .depth = d.depth,
                  .roll = d.roll,
                  .grip = d.grip};
      s.pedal = d.pedal;
      s.opening = haptic.opening(static_cast<int>(t));
      s.holding = haptic.rig(static_cast<int>(t)).end().holding();
      world->take(s);
    }
    world->tick();
    models->refresh();
    wait_for_workers();
    for (std::size_t t = 0; t < dofs.size(); ++t) {
      const ToolDofs& d = dofs[t];
      LocalContactModel m;
      m.tool = static_cast<std::uint32_t>(t), m.run = 1, m.seq = i + 1, m.tool_run = 1, m.tool_step = i;
      m.yaw = d.yaw, m.pitch = d.pitch, m.depth = d.depth, m.roll = d.roll, m.grip = d.grip;
      if (models->describe(static_cast<int>(t), m)) waiting.push_back(m);
    }
  }
  Result r = watch.result();
  r.note += fmt::format("{}energy at the end {:.4g} J", r.note.empty() ? "" : "; ", haptic.energy());
  return r;
}

/// Archives of changed bodies go into a folder that is gone with the object: they serve one point.
class OwnCache {
 public:
  OwnCache() {
    char name[] = "/tmp/palpate_stability_XXXXXX";
    if (mkdtemp(name)) folder_ = name;
    setenv("PALPATE_CACHE", folder_.c_str(), 1);
  }
  ~OwnCache() { std::filesystem::remove_all(folder_); }
  OwnCache(const OwnCache&) = delete;

 private:
  std::filesystem::path folder_;
};

/// Every body's material, its regions included.
template <class Change>
void change_materials(Scene& scene, Change&& change) {
  for (Body& body : scene.bodies) {
    std::visit([&](auto& spec) { change(spec.material); }, body);
    if (auto* solid = as<SolidSpec>(body))
      for (MaterialRegion& region : solid->materials) change(region.material);
  }
}

/// [m] largest extent of a body's surface.
double extent_of(const SurfaceMap& surface) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : surface.position) box.extend(x);
  return box.sizes().maxCoeff();
}

/// Held nodes of the quasi-static bodies, by a hundredth of their size.
void add_held_nodes(const Scene& scene, const Extent& extent, std::vector<Point>& points) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (!as<QuasiStaticSpec>(scene.bodies[b])) continue;
    for (const int count : extent.quick ? std::vector{1, 64, 512} : std::vector{1, 8, 32, 64, 96, 256, 512})
      points.push_back(
          {"held nodes", fmt::format("number, of body '{}'", name_of(scene.bodies[b])), std::to_string(count),
           [=] {
             const Archive archive = load_or_precompute(scene, ArchivePart::touchable)[b];
             return hold_nodes(archive, "spread", count, 0.01 * extent_of(archive.surface), TouchBody::kMaxContacts);
           },
           600});
  }
}

/// The scene's motion with the integrator's step of moving tissue at a share of its bound.
Result play_at_step(Scene scene, double share) {
  const std::vector<Archive> archives = load_or_precompute(scene, ArchivePart::surface);
  std::string bounds;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    auto* body = as<MovingSpec>(scene.bodies[b]);
    if (!body) continue;
    body->dynamic.step = 0;
    const StepSettings settings{scene.contact, scene.tools, 1 / scene.rates.haptic_hz};
    const DynamicOrgan organ(archives[b], *body, settings, model_maker(scene.bodies[b]));
    const double bound = max_step(integrator_of(body->dynamic), organ.model().frequency_bound(), body->dynamic.damping);
    body->dynamic.step = share * bound;
    bounds += fmt::format("; bound {:.3g} s of body '{}'", bound, name_of(scene.bodies[b]));
  }
  Result r = play(scene, archives, {});
  r.note += bounds;
  return r;
}

}  // namespace

std::vector<Point> scene_points(const Scene& scene, const Extent& extent) {
  std::vector<Point> points;
  const auto add = [&](const std::string& parameter, const std::string& value, const Bend& bend,
                       const std::function<void(Scene&)>& change = {}) {
    points.push_back({"scene", parameter, value,
                      [=] {
                        Scene changed = scene;
                        changed.passivity.controller = bend.controller;
                        std::optional<OwnCache> cache;
                        if (change) {
                          cache.emplace();
                          change(changed);
                        }
                        const std::vector<Archive> archives = load_or_precompute(changed, ArchivePart::surface);
                        return play(changed, archives, bend);
                      },
                      600});
  };
  add("as it is", "controller", {});
  add("as it is", "observer only", {.controller = false});
  for (double v : extent.quick ? std::vector{10.0} : std::vector{0.3, 3.0, 10.0, 100.0})
    add("speed of the motion [1]", fmt::format("{:g}", v), {.speed = v});
  for (double d : extent.quick ? std::vector{0.02} : std::vector{1e-12, 0.005, 0.02, 0.1})
    add("deeper by [m]", fmt::format("{:g}", d), {.deeper = d});
  for (double h : extent.quick ? std::vector<double>{} : std::vector{250.0, 4000.0})
    add("haptic rate [Hz]", fmt::format("{:g}", h), {}, [h](Scene& s) { s.rates.haptic_hz = h; });
  for (double f : extent.quick ? std::vector{1e3} : std::vector{1e-3, 1e3, 1e6})
    add("young, times [1]", fmt::format("{:g}", f), {},
        [f](Scene& s) { change_materials(s, [f](Material& m) { m.young *= f; }); });
  for (double nu : extent.quick ? std::vector{0.49999} : std::vector{0.0, 0.499, 0.49999})
    add("poisson [1]", fmt::format("{:g}", nu), {},
        [nu](Scene& s) { change_materials(s, [nu](Material& m) { m.poisson = nu; }); });
  if (std::ranges::any_of(scene.bodies, [](const Body& body) { return as<MovingSpec>(body) != nullptr; }))
    for (double share : extent.quick ? std::vector{1.5} : std::vector{0.1, 0.5, 0.999, 1.001, 1.5, 10.0})
      points.push_back({"scene", "step of moving tissue / bound [1]", fmt::format("{:g}", share),
                        [=] { return play_at_step(scene, share); }, 600});
  add_held_nodes(scene, extent, points);
  return points;
}

}  // namespace palpate::stability
