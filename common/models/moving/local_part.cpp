#include "common/models/moving/local_part.hpp"

#include <algorithm>

#include "common/dynamics/spec.hpp"
#include "common/models/kind.hpp"
#include "common/tool/safety.hpp"

namespace palpate {

LocalPart::LocalPart(const StepSettings& settings, const TissueLimits& limits) : limits_(limits) {
  for (const Tool& tool : settings.tools) {
    of_tool_.emplace_back(tool, settings.contact, settings.dt);
    pressing_.push_back(2 * limits.contact_modulus() * abilities_of(tool).radius);
  }
}

// [m] by all tools together, since what one has moved may press another.
double LocalPart::moved(const ToolsInStep& in) {
  double moved = 0;
  for (std::size_t t = 0; t < of_tool_.size(); ++t) {
    const MovingTool& tool = in.tools[t];
    ToolReach& reach = of_tool_[t].reach();
    if (!reach.begun()) {
      double at_start = 0;
      for (int p = 0; p < tool.size(); ++p) {
        const double radius = tool.radius(p);
        at_start = std::max({at_start, limits_.reach_at_start(tool.axis(p).start, radius),
                             limits_.reach_at_start(tool.axis(p).end, radius)});
      }
      reach.begin(tool, at_start);
    }
    moved += reach.of(tool);
  }
  return moved;
}

LawOutcome LocalPart::touch(const ToolsInStep& in, std::span<ToolLoad> loads) {
  const double moved = this->moved(in);
  for (std::size_t t = 0; t < of_tool_.size(); ++t) {
    const double stiffness = of_tool_[t].model().stiffness + pressing_[t];
    ToolLoad load = of_tool_[t].load(in.tools[t], in.step, stiffness * (moved + kSlack) + limits_.weight());
    if (of_tool_[t].stale()) load.flags |= stale_model;
    if (of_tool_[t].late()) load.flags |= late_tissue;
    if (of_tool_[t].limited()) load.flags |= implausible_force;
    loads[t].add(load);
  }
  return {};
}

void LocalPart::state(State& s, std::span<const MovingTool>) {
  for (LocalBody& body : of_tool_) body.state(s);
}

std::unique_ptr<BodyPart> make_haptic_part(const MovingSpec&, const Archive&, const StepSettings&) {
  return nullptr;
}

}  // namespace palpate
