#include "tools/film/log_figures.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "common/node/handling_summary.hpp"
#include "common/tool/dofs_of.hpp"
#include "idl/topics.hpp"

namespace palpate {
namespace {

constexpr double kCourseInterval = 0.01;  // [s]

/// Of ForceFlag's bits, those that tell of something that a trainer should know.
constexpr std::array<const char*, 9> kFlags{"force_limited", "slew_limited",      "fault",
                                            nullptr,         "stale_model",       "passivity_limited",
                                            "silent_device", "implausible_force", "late_tissue"};

}  // namespace

LogFigures::LogFigures(const Scene& scene, std::map<std::uint32_t, Resection> resections)
    : scene_(scene), resections_(std::move(resections)) {
  for (const Tool& tool : scene.tools) tools_.push_back({.trocar = make_trocar(tool.pivot, tool.axis, tool.up)});
}

// By the haptic node's clock, which knows when a step was; each run of it begins where the log has it.
double LogFigures::time_of(const ToolState& state) {
  const double own = 1e-9 * static_cast<double>(state.sense_ns);
  if (state.run != run_) shift_ = now_ - own;
  run_ = state.run;
  return own + shift_;
}

void LogFigures::look(const ToolState& state) {
  if (state.tool >= tools_.size()) return;
  const double time = time_of(state);
  OfTool& tool = tools_[state.tool];
  const Eigen::Vector3d tip = tip_pose(tool.trocar, dofs_of(state)).translation();
  const Eigen::Vector3d force = Eigen::Map<const Eigen::Vector3d>(tool.force.force.data());
  tool.handling.look(time, tip, force);
  ++tool.steps;
  for (std::size_t bit = 0; bit < tool.flagged.size(); ++bit) tool.flagged[bit] += tool.force.flags >> bit & 1;
  if (tool.latest == 0 || time - course_[tool.latest - 1].time >= kCourseInterval) {
    course_.push_back({time, state.tool, tip, 0});
    tool.latest = course_.size();
  }
  double& largest = course_[tool.latest - 1].force;
  largest = std::max(largest, force.norm());
}

void LogFigures::look(const TopologyChange& change) {
  if (change.cause >= lost_[change.body].size()) return;
  lost_[change.body][change.cause] += change.removed.size();
  const auto resection = resections_.find(change.body);
  if (change.cause == cut && resection != resections_.end()) resection->second.cut(change.removed);
}

void LogFigures::look(const LogEvent& event) {
  now_ = 1e-9 * static_cast<double>(log_time_.since_start(event.receive_ns));
  ForceState force;
  ToolState tool;
  TopologyChange change;
  TaskRecord task;
  if (event.read(topics::tool_state, tool)) return look(tool);
  if (event.read(topics::force_state, force) && force.tool < tools_.size()) {
    tools_[force.tool].force = force;
    ++tools_[force.tool].forces;
  }
  if (event.read(topics::topology_change, change)) look(change);
  if (event.read(topics::task_record, task)) tasks_[task.body] = task;
}

nlohmann::ordered_json LogFigures::json() const {
  nlohmann::ordered_json all{{"tools", nlohmann::ordered_json::array()}};
  for (std::size_t t = 0; t < tools_.size(); ++t) {
    const OfTool& tool = tools_[t];
    nlohmann::ordered_json one = handling_summary(scene_.tools[t].name, tool.handling.figures());
    if (2 * tool.forces < tool.steps) {
      one.erase("force_change_max_n");
      one["steps_per_force"] = tool.forces == 0 ? 0 : (tool.steps + tool.forces / 2) / tool.forces;
    }
    for (std::size_t bit = 0; bit < kFlags.size(); ++bit)
      if (kFlags[bit] && tool.flagged[bit] > 0) one["flags"][kFlags[bit]] = tool.flagged[bit];
    all["tools"].push_back(one);
  }
  for (const auto& [body, lost] : lost_)
    if (body < scene_.bodies.size() && lost[cut] + lost[torn] + lost[fell_away] > 0)
      all["tissue"].push_back({{"body", name_of(scene_.bodies[body])},
                               {"cut", lost[cut]},
                               {"torn", lost[torn]},
                               {"fallen", lost[fell_away]}});
  for (const auto& [body, resection] : resections_)
    all["resections"].emplace_back(resection_summary(name_of(scene_.bodies[body]), resection));
  for (const auto& [body, task] : tasks_)
    if (body < scene_.bodies.size()) all["tasks"].emplace_back(task_summary(name_of(scene_.bodies[body]), task));
  return all;
}

}  // namespace palpate
