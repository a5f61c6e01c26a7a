#include "tools/solve_dynamic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "common/realtime/shutdown.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/scene_changes.hpp"
#include "tools/drive/lock_step.hpp"
#include "tools/shared/choose_body.hpp"
#include "tools/solution_file.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

/// The states of a run, as they come.
class Frames {
 public:
  explicit Frames(const DynamicArguments& to) : folder_(to.states), file_(to.csv) {
    if (!file_.empty()) csv_.open(file_, std::ios::binary);
    if (folder_.empty()) return;
    if (fs::exists(folder_) && !(fs::is_directory(folder_) && fs::is_empty(folder_)))
      throw std::runtime_error(folder_.string() + ": is there already, and no empty folder");
    fs::create_directories(folder_);
  }

  void write(double time, const SolutionTable& table) {
    if (!file_.empty()) {
      if (count_ == 0) csv_ << "time," << csv_columns(table) << "\n";
      csv_ << csv_lines(table, fmt::format("{:.12g},", time));
    }
    if (!folder_.empty()) {
      const std::string name = fmt::format("state_{:05}.vtu", count_);
      write_vtu(table, folder_ / name);
      series_ += fmt::format("<DataSet timestep=\"{:.12g}\" file=\"{}\"/>\n", time, name);
    }
    ++count_;
  }

  /// The list of states by which ParaView shows a motion.
  void finish() {
    if (!file_.empty() && !csv_.flush()) throw std::runtime_error(file_.string() + ": cannot be written");
    if (folder_.empty()) return;
    const fs::path list = folder_ / "states.pvd";
    std::ofstream out(list, std::ios::binary);
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n"
        << series_ << "</Collection>\n</VTKFile>\n";
    if (!out.flush()) throw std::runtime_error(list.string() + ": cannot be written");
  }

  int count() const { return count_; }

 private:
  const fs::path folder_, file_;
  std::ofstream csv_;
  std::string series_;
  int count_ = 0;
};

Scene scene_of(const DynamicArguments& arguments) {
  std::vector<SceneChange> changes = parse_changes(arguments.set);
  Scene scene = load_scene(arguments.scene, changes);
  if (arguments.precision.empty()) return scene;
  const std::string name = name_of(choose_body(scene, arguments.body));
  changes.push_back({fmt::format("body.{}.dynamic.precision", name), arguments.precision});
  return load_scene(arguments.scene, changes);
}

/// The place of the scene's body among those that move.
int organ_of(const DynamicWorld& world, const Scene& scene, const Body& body) {
  const auto place = static_cast<int>(&body - scene.bodies.data());
  const auto found = std::ranges::find(world.bodies(), place);
  if (found == world.bodies().end())
    throw std::runtime_error(fmt::format("--dynamic: body '{}' is a {}, which has no inertia of its own to move with",
                                         name_of(body), kind_of(body)));
  return static_cast<int>(found - world.bodies().begin());
}

SolutionTable state_of(const DynamicOrgan& organ, const SurfaceMap& map) {
  SolutionTable table{.node = map.node_number, .position = map.position};
  for (int n = 0; n < map.size(); ++n) {
    table.displacement.push_back(organ.displacement(n));
    table.velocity.push_back(organ.model().velocity(n));
  }
  for (int t = 0; t < organ.topology().size(); ++t)
    if (organ.topology().alive(t)) table.tetrahedra.push_back(organ.mesh().tetrahedra[t]);
  return table;
}

void print(const DynamicArguments& arguments, double time, const SolutionTable& last, int states) {
  const auto most = std::ranges::max_element(last.displacement, {}, [](const auto& u) { return u.norm(); });
  const int node = last.node[most - last.displacement.begin()];
  if (arguments.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"method", "dynamic"},
                                              {"seconds", time},
                                              {"nodes", last.node.size()},
                                              {"states", states},
                                              {"max_displacement_m", most->norm()},
                                              {"max_displacement_node", node}}
                           .dump());
  else
    fmt::print("dynamic: {} nodes, {} states up to {:.6g} s; then the largest displacement {:.6g} m, at node {}\n",
               last.node.size(), states, time, most->norm(), node);
}

}  // namespace

void solve_dynamic(const DynamicArguments& arguments) {
  const Scene scene = scene_of(arguments);
  const Body& body = choose_body(scene, arguments.body);
  drive::lock_step_devices(scene);  // a motion that cannot be read is told of before anything is computed
  const std::vector<Archive> archives = load_or_precompute(scene, ArchivePart::surface);
  drive::LockStep run(scene, archives);
  const int place = organ_of(run.simulator().tissue(), scene, body);
  const DynamicOrgan& organ = run.simulator().tissue().organ(place);
  const SurfaceMap& map = archives[run.simulator().tissue().bodies()[place]].surface;
  const double dt = run.simulator().dt();
  const auto ticks = std::max(1L, std::lround(arguments.seconds / dt));
  const long every = arguments.every > 0 ? std::lround(arguments.every / dt) : ticks;
  if (every < 1) throw std::runtime_error(fmt::format("--every: a tick of this scene lasts {} s", dt));
  catch_shutdown_signals();
  Frames frames(arguments);
  for (long tick = 1; tick <= ticks; ++tick) {
    run.step();
    if (tick % every == 0 || tick == ticks) frames.write(tick * dt, state_of(organ, map));
    stop_if_interrupted();
  }
  frames.finish();
  print(arguments, ticks * dt, state_of(organ, map), frames.count());
}

}  // namespace palpate
