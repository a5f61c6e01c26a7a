// A scene's own bodies and tools at the edge.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "common/scene/ensure_archive.hpp"
#include "tools/rig/kinds.hpp"
#include "tools/rig/press_rig.hpp"
#include "tools/rig/scripted_tools.hpp"
#include "tools/stability/held_nodes.hpp"
#include "tools/stability/kinds.hpp"
#include "tools/stability/watch.hpp"

namespace palpate::stability {
namespace {

/// How a scene's own scripted motion is bent.
struct Bend {
  double speed = 1;   ///< times as fast
  double deeper = 0;  ///< [m] further along the shaft, once the motion has begun
  bool controller = true;
};

/// Fails the row where moving tissue was flung, or has more energy than the work. Where it is loaded this does work
/// too, and its reach alone counts.
void judge_tissue(const Scene& scene, std::span<const int> bodies, std::span<const TissueWatch> watches, Result& row) {
  for (std::size_t i = 0; i < watches.size(); ++i) {
    const Body& body = scene.bodies[bodies[i]];
    Result tissue{.note = {}};
    watches[i].judge(tissue, !is_loaded(*as<MovingSpec>(body)));
    if (tissue.outcome != Outcome::failed) continue;
    row.outcome = Outcome::failed;
    row.note += fmt::format("{}tissue of '{}': {}", row.note.empty() ? "" : "; ", name_of(body), tissue.note);
  }
}

/// The scene as the nodes run it, in lock step.
Result play(const Scene& scene, const std::vector<Archive>& archives, const Bend& bend) {
  PressRig rig(scene, archives);
  ScriptedTools tools(scene);
  const auto at = [&](double time) {
    const auto script = tools.at(time);
    std::vector<ToolDofs> dofs(script.begin(), script.end());
    for (ToolDofs& d : dofs) d.depth += bend.deeper * std::min(1.0, time);
    return dofs;
  };
  rig.start(at(0));
  Watch watch;
  std::vector<TissueWatch> tissue(rig.tissue().organs());
  for (int i = 0; i < 60000; ++i) {
    const double time = i * rig.dt() * bend.speed;
    if (time > tools.duration()) break;
    rig.step(at(time));
    watch.look(rig.haptic());
    for (int o = 0; o < rig.tissue().organs(); ++o) tissue[o].look(rig.tissue().organ(o), work_on(rig.tissue(), o));
  }
  Result r = watch.result(scene.passivity.reserve);
  judge_tissue(scene, rig.tissue().bodies(), tissue, r);
  r.note += fmt::format("{}energy at the end {:.4g} J", r.note.empty() ? "" : "; ", rig.simulator().energy());
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
  for (Body& body : scene.bodies)
    for (Material* material : std::visit([](auto& spec) { return materials_in(spec); }, body)) change(*material);
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
    if (!std::visit([](const auto& spec) { return holds_nodes(spec); }, scene.bodies[b])) continue;
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
    Dynamic* motion = find_motion(scene.bodies[b]);
    if (!motion) continue;
    motion->step = 0;
    const StepSettings settings{scene.contact, scene.tools, 1 / scene.rates.haptic_hz};
    const auto organ =
        std::visit([&](const auto& spec) { return make_organ(spec, archives[b], settings); }, scene.bodies[b]);
    const double bound = max_step(motion->integrator, organ->model().frequency_bound(), motion->damping);
    motion->step = share * bound;
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
  if (std::ranges::any_of(scene.bodies, [](const Body& body) { return find_motion(body) != nullptr; }))
    for (double share : extent.quick ? std::vector{1.5} : std::vector{0.1, 0.5, 0.999, 1.001, 1.5, 10.0})
      points.push_back({"scene", "step of moving tissue / bound [1]", fmt::format("{:g}", share),
                        [=] { return play_at_step(scene, share); }, 600});
  add_held_nodes(scene, extent, points);
  return points;
}

}  // namespace palpate::stability
