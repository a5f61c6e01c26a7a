#include "haptic_node/verify.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <map>
#include <stdexcept>

#include "common/bus/log_reader.hpp"
#include "common/kernels/kernels.hpp"
#include "common/scene/scene.hpp"
#include "common/tensors/find_archive.hpp"
#include "haptic_node/code_path.hpp"
#include "haptic_node/haptic_step.hpp"
#include "idl/topics.hpp"

namespace palpate {
namespace {

/// What was recorded of one step: per tool its input and its force.
struct RecordedStep {
  std::map<std::uint32_t, ToolDofs> dofs;
  std::map<std::uint32_t, ForceState> force;
};

struct RecordedRun {
  std::map<std::uint64_t, RecordedStep> steps;
  std::map<std::uint64_t, HapticKeyframe> keyframes;
};

std::map<std::uint64_t, RecordedRun> read_runs(LogReader& log) {
  std::map<std::uint64_t, RecordedRun> runs;
  LogEvent event;
  ToolState tool;
  ForceState force;
  HapticKeyframe keyframe;
  while (log.next(event)) {
    if (event.read(topics::tool_state, tool))
      runs[tool.run].steps[tool.step].dofs[tool.tool] = {tool.yaw, tool.pitch, tool.depth, tool.roll, tool.grip};
    else if (event.read(topics::force_state, force))
      runs[force.run].steps[force.step].force[force.tool] = force;
    else if (event.read(topics::haptic_keyframe, keyframe))
      runs[keyframe.run].keyframes[keyframe.step] = keyframe;
  }
  return runs;
}

bool same_bits(const Eigen::Vector3d& a, const std::array<double, 3>& b) { return std::memcmp(a.data(), b.data(), sizeof b) == 0; }

/// Takes up the code path that a keyframe names; the software must be this one.
void take_code_path(const std::string& recorded) {
  const auto [kernels_name, software] = split_code_path(recorded);
  if (software != this_software())
    throw std::runtime_error(fmt::format("the log was made by {}; this is {}, whose arithmetic may differ", software, this_software()));
  try {
    kernels::use(kernels_name);
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("the log was made on code path {}, which cannot run here: {}", kernels_name, error.what()));
  }
}

class RunVerifier {
 public:
  RunVerifier(const Scene& scene, const std::vector<Archive>& archives, VerifyReport& report)
      : scene_(scene), archives_(archives), report_(report) {}

  void verify(const RecordedRun& run) {
    auto keyframe = run.keyframes.begin();
    while (keyframe != run.keyframes.end() && report_.mismatch.empty()) {
      const std::uint64_t reached = verify_from(run, keyframe->second);
      keyframe = run.keyframes.upper_bound(reached);
    }
  }

 private:
  /// Goes on as long as no input is missing; returns the first step that could not be computed.
  std::uint64_t verify_from(const RecordedRun& run, const HapticKeyframe& keyframe) {
    HapticStep haptic(scene_, archives_);
    haptic.restore(keyframe.state);
    const auto interval = static_cast<std::uint64_t>(std::lround(1 / keyframe.dt));
    std::vector<ToolDofs> dofs(haptic.tools());
    std::uint64_t step = keyframe.step;
    const std::uint64_t last = run.steps.empty() ? step : run.steps.rbegin()->first;
    for (; step <= last && report_.mismatch.empty(); ++step) {
      const auto recorded = run.steps.find(step);
      const bool whole = recorded != run.steps.end() && static_cast<int>(recorded->second.dofs.size()) == haptic.tools();
      if (!whole) {
        const auto next = run.keyframes.upper_bound(step);
        report_.gaps.push_back(next == run.keyframes.end()
                                   ? fmt::format("cannot verify from step {}: its input is not in the log, and no keyframe follows", step)
                                   : fmt::format("cannot verify steps {} to {}: the input of step {} is not in the log", step, next->first - 1, step));
        return next == run.keyframes.end() ? last + 1 : next->first - 1;
      }
      for (const auto& [tool, d] : recorded->second.dofs)
        if (tool < dofs.size()) dofs[tool] = d;
      if (step % interval == 0) haptic.forget_factors();
      haptic.step(dofs);
      ++report_.steps;
      compare(haptic, step, recorded->second);
    }
    return step;
  }

  void compare(const HapticStep& haptic, std::uint64_t step, const RecordedStep& recorded) {
    for (int t = 0; t < haptic.tools() && report_.mismatch.empty(); ++t) {
      const auto force = recorded.force.find(static_cast<std::uint32_t>(t));
      if (force == recorded.force.end()) {
        report_.gaps.push_back(fmt::format("cannot verify the force of tool {} at step {}: it is not in the log", t, step));
        continue;
      }
      if (same_bits(haptic.force(t), force->second.force) && same_bits(haptic.torque(t), force->second.torque)) {
        ++report_.forces;
        continue;
      }
      const auto& f = force->second.force;
      report_.mismatch = fmt::format("step {}, tool {}: recorded force ({:a}, {:a}, {:a}) N, computed ({:a}, {:a}, {:a}) N", step, t, f[0], f[1],
                                     f[2], haptic.force(t)[0], haptic.force(t)[1], haptic.force(t)[2]);
    }
  }

  const Scene& scene_;
  const std::vector<Archive>& archives_;
  VerifyReport& report_;
};

}  // namespace

VerifyReport verify_log(const std::filesystem::path& file) {
  LogReader log(file);
  const auto runs = read_runs(log);
  if (log.header().scene.empty()) throw std::runtime_error(fmt::format("{}: the log holds no scene, so its steps cannot be computed again", file.string()));
  const Scene scene = parse_scene(log.header().scene, file);
  VerifyReport report;
  report.damage = log.damage_text();
  for (const LogDamage& d : log.damage())
    if (!d.tail) report.gaps.push_back(fmt::format("{} bytes at byte {} are damaged", d.bytes, d.offset));
  for (const auto& [id, run] : runs)
    if (!run.keyframes.empty()) report.code_path = run.keyframes.begin()->second.code_path;
  if (report.code_path.empty()) throw std::runtime_error(fmt::format("{}: the log holds no keyframe to start from", file.string()));
  take_code_path(report.code_path);

  std::vector<Archive> archives;
  for (const Body& body : scene.bodies) archives.push_back(find_archive(scene, body, ArchivePart::touchable));
  RunVerifier verifier(scene, archives, report);
  for (const auto& [id, run] : runs)
    if (!run.keyframes.empty() && report.mismatch.empty()) verifier.verify(run);
  return report;
}

}  // namespace palpate
