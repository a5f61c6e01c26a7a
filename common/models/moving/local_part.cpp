#include "common/models/moving/local_part.hpp"

#include "common/dynamics/spec.hpp"
#include "common/models/kind.hpp"
#include "common/tool/safety.hpp"

namespace palpate {

LocalPart::LocalPart(const StepSettings& settings) {
  for (const Tool& tool : settings.tools) of_tool_.emplace_back(tool, settings.contact.friction, settings.dt);
}

LawOutcome LocalPart::touch(const ToolsInStep& in, std::span<ToolLoad> loads) {
  for (std::size_t t = 0; t < of_tool_.size(); ++t) {
    ToolLoad load = of_tool_[t].load(in.tools[t], in.step);
    if (of_tool_[t].stale()) load.flags |= stale_model;
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
