#include "tools/film/log_figures.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/node/handling_summary.hpp"
#include "common/sim/leaving.hpp"
#include "common/tool/dofs_of.hpp"
#include "idl/topics.hpp"

namespace palpate {
namespace {

constexpr double kCourseInterval = 0.01;  // [s]
constexpr std::size_t kMayWait = 1000;    // steps for a force: a second

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

// A log has the messages as they came, those of one topic in batches: each step is counted with its own force.
void LogFigures::look(const ToolState& state) {
  if (state.tool >= tools_.size()) return;
  OfTool& tool = tools_[state.tool];
  if (!tool.waiting.empty() && tool.waiting.back().state.run != state.run) settle(tool, 0);
  std::erase_if(tool.forces_ahead, [&](const ForceState& f) { return f.run != state.run; });
  const bool goes_on = tool.newest && tool.newest->run == state.run && state.step > tool.newest->step;
  if (goes_on) missing_ += state.step - tool.newest->step - 1;
  tool.newest = state;
  const double time = time_of(state);
  if (!scene_begin_) scene_begin_ = time - static_cast<double>(state.step) / scene_.rates.haptic_hz;
  tool.waiting.push_back({state, time});
  settle(tool, kMayWait);
}

void LogFigures::look(const ForceState& force) {
  if (force.tool >= tools_.size()) return;
  OfTool& tool = tools_[force.tool];
  ++tool.forces;
  tool.forces_ahead.push_back(force);
  settle(tool, kMayWait);
}

void LogFigures::settle(OfTool& tool, std::size_t may_wait) {
  for (; !tool.waiting.empty(); tool.waiting.pop_front()) {
    const ToolState& state = tool.waiting.front().state;
    std::deque<ForceState>& ahead = tool.forces_ahead;
    for (; !ahead.empty() && ahead.front().run == state.run && ahead.front().step <= state.step; ahead.pop_front())
      tool.force = ahead.front();
    const bool may_come = ahead.empty() && (tool.force.run != state.run || tool.force.step < state.step);
    if (may_come && tool.waiting.size() <= may_wait) return;
    count(tool, tool.waiting.front());
  }
}

void LogFigures::count(OfTool& tool, const Waiting& step) {
  const Eigen::Vector3d tip = tip_pose(tool.trocar, dofs_of(step.state)).translation();
  const Eigen::Vector3d force = Eigen::Map<const Eigen::Vector3d>(tool.force.force.data());
  tool.handling.look(step.time, tip, force);
  ++tool.steps;
  count_flags(tool, step);
  if (tool.latest == 0 || step.time - course_[tool.latest - 1].time >= kCourseInterval) {
    course_.push_back({step.time, step.state.tool, tip, 0});
    tool.latest = course_.size();
  }
  double& largest = course_[tool.latest - 1].force;
  largest = std::max(largest, force.norm());
}

void LogFigures::count_flags(OfTool& tool, const Waiting& step) {
  if (tool.run != step.state.run) end_run(tool);
  const bool silent = (tool.force.flags & silent_device) != 0;
  if (!silent) tool.silence.reset();
  if (silent && !tool.silence) tool.silence = Silence{step.time, tool.flagged};
  for (std::size_t bit = 0; bit < tool.flagged.size(); ++bit) tool.flagged[bit] += tool.force.flags >> bit & 1;
  tool.run = step.state.run;
  tool.time = step.time;
}

// A run that ends under a force lets it fade, which is not told of as a silent device.
void LogFigures::end_run(OfTool& tool) {
  if (tool.silence && tool.time - tool.silence->begin < kMaxLeaving)
    for (std::size_t bit = 0; bit < tool.flagged.size(); ++bit)
      if (kOfLeaving >> bit & 1) tool.flagged[bit] = tool.silence->before[bit];
  tool.silence.reset();
}

void LogFigures::finish() {
  for (OfTool& tool : tools_) {
    settle(tool, 0);
    end_run(tool);
  }
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
  if (event.read(topics::force_state, force)) return look(force);
  if (event.read(topics::topology_change, change)) look(change);
  if (event.read(topics::task_record, task)) tasks_[task.body] = task;
}

bool LogFigures::has_forces() const {
  return std::ranges::any_of(tools_, [](const OfTool& tool) { return tool.forces > 0; });
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
