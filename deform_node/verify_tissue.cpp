#include "deform_node/verify_tissue.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "common/bus/log_reader.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/scene/find_archive.hpp"
#include "common/sim/dynamic_world.hpp"
#include "idl/topics.hpp"

namespace palpate {
namespace {

/// What was recorded of one start of a deformation node.
struct RecordedTissue {
  std::map<std::uint64_t, DeformStep> steps;  ///< by tick
  std::map<std::uint64_t, DeformKeyframe> keyframes;
};

struct Recorded {
  std::map<std::uint64_t, RecordedTissue> runs;
  std::map<std::tuple<std::uint64_t, std::uint32_t, std::uint64_t>, ToolState> tools;  ///< by run, tool and step
};

Recorded read_all(LogReader& log) {
  Recorded all;
  LogEvent event;
  ToolState tool;
  DeformStep step;
  DeformKeyframe keyframe;
  while (log.next(event)) {
    if (event.read(topics::tool_state, tool))
      all.tools[{tool.run, tool.tool, tool.step}] = tool;
    else if (event.read(topics::deform_step, step))
      all.runs[step.run].steps[step.tick] = step;
    else if (event.read(topics::deform_keyframe, keyframe))
      all.runs[keyframe.run].keyframes[keyframe.tick] = keyframe;
  }
  return all;
}

class TissueVerifier {
 public:
  TissueVerifier(const Scene& scene, const std::vector<Archive>& archives, const Recorded& recorded,
                 TissueReport& report)
      : scene_(scene), archives_(archives), recorded_(recorded), report_(report) {}

  void verify(const RecordedTissue& run) {
    auto keyframe = run.keyframes.begin();
    while (keyframe != run.keyframes.end() && report_.mismatch.empty())
      keyframe = run.keyframes.upper_bound(verify_from(run, keyframe->second));
  }

 private:
  /// Goes on while nothing is missing; returns the first tick that could not be computed.
  std::uint64_t verify_from(const RecordedTissue& run, const DeformKeyframe& keyframe) {
    DynamicWorld world(scene_, archives_);
    world.restore(keyframe.state);
    std::uint64_t tick = keyframe.tick;
    const std::uint64_t last = run.steps.empty() ? 0 : run.steps.rbegin()->first;
    for (; tick <= last; ++tick) {
      stop_if_interrupted();
      const auto step = run.steps.find(tick);
      const std::string lack = step == run.steps.end() ? "what it came to" : lack_of(world, step->second);
      if (!lack.empty()) {
        report_.gaps.push_back(fmt::format("cannot verify tick {} of the tissue: {} is not in the log", tick, lack));
        return tick;
      }
      world.tick();
      ++report_.ticks;
      if (world.hash() == step->second.hash) continue;
      report_.mismatch =
          fmt::format("tick {}: recorded state {:016x}, computed {:016x}", tick, step->second.hash, world.hash());
      return tick;
    }
    return tick;
  }

  /// Gives the world what the tick consumed; what of it is not there, in words, or nothing.
  std::string lack_of(DynamicWorld& world, const DeformStep& step) const {
    for (const ConsumedStep& consumed : step.consumed)
      if (!take(world, consumed))
        return fmt::format("step {} of tool {}, which it consumed,", consumed.step, consumed.tool);
    return {};
  }

  bool take(DynamicWorld& world, const ConsumedStep& consumed) const {
    if (consumed.step == tool_left) {
      if (consumed.tool >= static_cast<std::uint32_t>(world.tools())) return false;
      world.leave(static_cast<int>(consumed.tool));
      return true;
    }
    const auto tool = recorded_.tools.find({consumed.run, consumed.tool, consumed.step});
    return tool != recorded_.tools.end() && world.take(tool->second);
  }

  const Scene& scene_;
  const std::vector<Archive>& archives_;
  const Recorded& recorded_;
  TissueReport& report_;
};

}  // namespace

TissueReport verify_tissue(const std::filesystem::path& file, const Scene& scene) {
  LogReader log(file);
  const Recorded recorded = read_all(log);
  if (recorded.runs.empty()) return {};
  std::vector<Archive> archives;
  for (const Body& body : scene.bodies) archives.push_back(find_archive(scene, body, ArchivePart::surface));
  TissueReport report;
  TissueVerifier verifier(scene, archives, recorded, report);
  for (const auto& [id, run] : recorded.runs)
    if (report.mismatch.empty()) verifier.verify(run);
  return report;
}

}  // namespace palpate
