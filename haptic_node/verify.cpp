#include "haptic_node/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>

#include "common/bus/log_reader.hpp"
#include "common/kernels/code_path.hpp"
#include "common/kernels/kernels.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/scene/find_archive.hpp"
#include "common/scene/scene.hpp"
#include "common/sim/haptic_step.hpp"
#include "common/sim/step_messages.hpp"
#include "common/tool/dofs_of.hpp"
#include "haptic_node/recorded_models.hpp"
#include "idl/fields.hpp"
#include "idl/topics.hpp"

namespace palpate {
namespace {

/// Which local contact model a step used.
struct ModelName {
  std::uint64_t run, seq;
};

/// What was recorded of one step: per tool its inputs and its force.
struct RecordedStep {
  std::map<std::uint32_t, ToolDofs> dofs;
  std::map<std::uint32_t, ModelName> model;  ///< of tools that used one
  std::map<std::uint32_t, ForceState> force;
  std::map<std::uint32_t, TaskRecord> task;  ///< by body
};

struct RecordedRun {
  std::map<std::uint64_t, RecordedStep> steps;
  std::map<std::uint64_t, HapticKeyframe> keyframes;
};

struct Recorded {
  std::map<std::uint64_t, RecordedRun> runs;
  RunOrder deform_runs;
  bool thinned = false;  ///< not every step's force was to be kept
};

Recorded read_log(LogReader& log) {
  Recorded recorded;
  auto& runs = recorded.runs;
  LogEvent event;
  ToolState tool;
  ForceState force;
  HapticKeyframe keyframe;
  LocalContactModel model;
  TaskRecord task;
  while (log.next(event)) {
    stop_if_interrupted();
    if (event.read(topics::tool_state, tool)) {
      RecordedStep& step = runs[tool.run].steps[tool.step];
      step.dofs[tool.tool] = dofs_of(tool);
      if (tool.local_model_seq != 0) step.model[tool.tool] = {tool.local_model_run, tool.local_model_seq};
    } else if (event.read(topics::force_state, force))
      runs[force.run].steps[force.step].force[force.tool] = force;
    else if (event.read(topics::task_record, task))
      runs[task.run].steps[task.step].task[task.body] = task;
    else if (event.read(topics::haptic_keyframe, keyframe))
      runs[keyframe.run].keyframes[keyframe.step] = keyframe;
    else if (event.read(topics::local_contact_model, model))
      recorded.deform_runs.try_emplace(model.run, static_cast<int>(recorded.deform_runs.size()));
  }
  recorded.thinned = log.thinned_steps() > 0;
  return recorded;
}

/// What a task record says, under another one's numbers and times.
TaskRecord numbered_like(const TaskRecord& other, TaskRecord record) {
  record.run = other.run;
  record.seq = other.seq;
  record.step = other.step;
  record.sense_ns = other.sense_ns;
  record.publish_ns = other.publish_ns;
  return record;
}

bool same_bits(const Eigen::Vector3d& a, const std::array<double, 3>& b) {
  using Bits = std::array<std::uint64_t, 3>;
  return std::bit_cast<Bits>(std::array{a[0], a[1], a[2]}) == std::bit_cast<Bits>(b);
}

/// Takes up the code path that a keyframe names; the software must be this one.
void take_code_path(const std::string& recorded) {
  const auto [kernels_name, software] = split_code_path(recorded);
  if (software != this_software())
    throw std::runtime_error(
        fmt::format("the log was made by {}; this is {}, whose arithmetic may differ", software, this_software()));
  try {
    kernels::use(kernels_name);
  } catch (const std::exception& error) {
    throw std::runtime_error(
        fmt::format("the log was made on code path {}, which cannot run here: {}", kernels_name, error.what()));
  }
}

/// [steps] at the end of a log that may lack something: a recorder that ends hears one topic out after another.
constexpr std::uint64_t kLastSteps = 20;

class RunVerifier {
 public:
  RunVerifier(const Scene& scene, const std::vector<Archive>& archives, bool thinned, VerifyReport& report)
      : scene_(scene), archives_(archives), thinned_(thinned), report_(report) {}

  void verify(const RecordedRun& run, RecordedModels& models) {
    models_ = &models;
    auto keyframe = run.keyframes.begin();
    while (keyframe != run.keyframes.end() && report_.mismatch.empty()) {
      const std::uint64_t reached = verify_from(run, keyframe->second);
      keyframe = run.keyframes.upper_bound(std::max(reached, keyframe->first));
    }
  }

 private:
  /// Goes on as long as no input is missing; returns the first step that could not be computed.
  std::uint64_t verify_from(const RecordedRun& run, const HapticKeyframe& keyframe) {
    HapticStep haptic(scene_, archives_);
    if (keyframe.dt != haptic.dt()) {
      report_.gaps.push_back(
          fmt::format("cannot verify from step {}: its keyframe has steps of {} s, the scene of {} s", keyframe.step,
                      keyframe.dt, haptic.dt()));
      return keyframe.step;
    }
    haptic.restore(keyframe.state);
    const auto interval = static_cast<std::uint64_t>(std::lround(1 / keyframe.dt));
    std::vector<ToolDofs> dofs(haptic.tools());
    std::uint64_t step = keyframe.step;
    const std::uint64_t last = run.steps.empty() ? step : run.steps.rbegin()->first;
    for (; step <= last && report_.mismatch.empty(); ++step) {
      stop_if_interrupted();
      const auto recorded = run.steps.find(step);
      const bool whole =
          recorded != run.steps.end() && static_cast<int>(recorded->second.dofs.size()) == haptic.tools();
      const std::string missing = whole ? feed_models(haptic, recorded->second) : "input";
      if (!missing.empty()) {
        if (last - step < kLastSteps) return last + 1;
        const auto next = run.keyframes.upper_bound(step);
        report_.gaps.push_back(
            next == run.keyframes.end()
                ? fmt::format("cannot verify from step {}: its {} is not in the log, and no keyframe follows", step,
                              missing)
                : fmt::format("cannot verify steps {} to {}: the {} of step {} is not in the log", step,
                              next->first - 1, missing, step));
        return next == run.keyframes.end() ? last + 1 : next->first - 1;
      }
      for (const auto& [tool, d] : recorded->second.dofs)
        if (tool < dofs.size()) dofs[tool] = d;
      if (step % interval == 0) haptic.forget_factors();
      haptic.step(dofs);
      ++report_.steps;
      const bool felt = thinned_ || static_cast<int>(recorded->second.force.size()) == haptic.tools();
      if (!felt && last - step < kLastSteps) return last + 1;
      compare(haptic, step, recorded->second);
      compare_tasks(haptic, step, recorded->second);
    }
    return step;
  }

  /// Gives each tool the model that the step used, if it is not the one in use. Returns what the log lacks, or nothing.
  std::string feed_models(HapticStep& haptic, const RecordedStep& recorded) {
    for (const auto& [tool, name] : recorded.model) {
      if (!haptic.has_moving_tissue() || static_cast<int>(tool) >= haptic.tools()) return "moving tissue";
      const LocalModel& used = haptic.local(static_cast<int>(tool)).model();
      if (used.run == name.run && used.seq == name.seq) continue;
      const LocalContactModel* model = models_->find(tool, name.run, name.seq);
      if (!model || !haptic.consume(*model)) return fmt::format("local contact model {} of tool {}", name.seq, tool);
    }
    return {};
  }

  void compare(const HapticStep& haptic, std::uint64_t step, const RecordedStep& recorded) {
    for (int t = 0; t < haptic.tools() && report_.mismatch.empty(); ++t) {
      const auto force = recorded.force.find(static_cast<std::uint32_t>(t));
      if (force == recorded.force.end()) {
        if (thinned_) continue;
        report_.gaps.push_back(
            fmt::format("cannot verify the force of tool {} at step {}: it is not in the log", t, step));
        continue;
      }
      const bool grip_agrees = haptic.grip_torque(t) == force->second.grip;
      const bool energy_agrees = haptic.energy() == force->second.energy;
      if (same_bits(haptic.force(t), force->second.force) && same_bits(haptic.torque(t), force->second.torque) &&
          grip_agrees && energy_agrees) {
        ++report_.forces;
        continue;
      }
      const auto& f = force->second.force;
      report_.mismatch = fmt::format(
          "step {}, tool {}: recorded force ({:a}, {:a}, {:a}) N, computed ({:a}, {:a}, {:a}) N; energy {:a} and {:a} "
          "J",
          step, t, f[0], f[1], f[2], haptic.force(t)[0], haptic.force(t)[1], haptic.force(t)[2], force->second.energy,
          haptic.energy());
    }
  }

  void compare_tasks(const HapticStep& haptic, std::uint64_t step, const RecordedStep& recorded) {
    if (recorded.task.empty()) return;
    for (const TaskRecord& now : task_records(haptic)) {
      const auto found = recorded.task.find(now.body);
      if (found == recorded.task.end() || !report_.mismatch.empty()) continue;
      const TaskRecord computed = numbered_like(found->second, now);
      if (computed == found->second) {
        ++report_.tasks;
        continue;
      }
      report_.mismatch = fmt::format(
          "step {}, body {}: recorded task with {:a} m inserted, {} contacts and {} drops, computed {:a} m, {} and {}",
          step, found->first, found->second.inserted, found->second.wall_contacts, found->second.drops,
          computed.inserted, computed.wall_contacts, computed.drops);
    }
  }

  const Scene& scene_;
  const std::vector<Archive>& archives_;
  bool thinned_;
  VerifyReport& report_;
  RecordedModels* models_ = nullptr;
};

/// Moving tissue goes without: its forces are in the models, and only where they were limited does it matter.
Archive archive_for_step(const Scene& scene, const Body& body) {
  if (owner_of(body) == Owner::haptic_node) return find_archive(scene, body, ArchivePart::touchable);
  return exists(archive_path(body)) ? find_archive(scene, body, ArchivePart::header) : Archive{};
}

}  // namespace

VerifyReport verify_log(const std::filesystem::path& file) {
  LogReader log(file);
  for (LogEvent event; log.header().scene.empty() && log.next(event);) {
  }
  if (log.header().scene.empty())
    throw std::runtime_error(
        fmt::format("{}: the log holds no scene, so its steps cannot be computed again", file.string()));
  return verify_log(file, parse_scene(log.header().scene, file));
}

VerifyReport verify_log(const std::filesystem::path& file, const Scene& scene) {
  LogReader log(file);
  const Recorded recorded = read_log(log);
  const auto& runs = recorded.runs;
  VerifyReport report;
  report.damage = log.damage_text();
  report.footer = log.footer();
  for (const LogDamage& d : log.damage())
    if (!d.tail) report.gaps.push_back(fmt::format("{} bytes at byte {} are damaged", d.bytes, d.offset));
  for (const auto& [id, run] : runs)
    if (!run.keyframes.empty()) report.code_path = run.keyframes.begin()->second.code_path;
  if (report.code_path.empty())
    throw std::runtime_error(fmt::format("{}: the log holds no keyframe to start from", file.string()));
  take_code_path(report.code_path);

  std::vector<Archive> archives;
  for (const Body& body : scene.bodies) archives.push_back(archive_for_step(scene, body));
  RunVerifier verifier(scene, archives, recorded.thinned, report);
  for (const auto& [id, run] : runs) {
    const auto first = run.keyframes.empty() ? run.steps.end() : run.steps.lower_bound(run.keyframes.begin()->first);
    report.before_keyframe += static_cast<std::uint64_t>(std::distance(run.steps.begin(), first));
    if (run.keyframes.empty() || !report.mismatch.empty()) continue;
    RecordedModels models(file, recorded.deform_runs, id);
    verifier.verify(run, models);
  }
  return report;
}

}  // namespace palpate
