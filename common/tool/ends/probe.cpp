#include "common/tool/ends/probe.hpp"

#include <fmt/format.h>

#include "common/tool/instrument.hpp"

namespace palpate {

EndAbilities abilities(const ProbeSpec& probe) {
  return {.radius = probe.radius,
          .radius_of = "a radius",
          .ball = probe.radius,
          .cautery = probe.cautery,
          .closing = probe.jaws};
}

std::vector<ToolPart> end_parts(const ProbeSpec& probe, const Tool& tool, double) {
  return probe_parts(probe.radius, tool.shaft_radius, tool.shaft_length);
}

std::string sentence(const ProbeSpec& probe, const Tool& tool) {
  std::string text = fmt::format("tool '{}': tip radius {} m", tool.name, probe.radius);
  if (probe.cautery) text += fmt::format(", cautery of radius {} m", probe.cautery->radius);
  if (probe.jaws)
    text += fmt::format(", jaws {} x {} m that close below {} rad", probe.jaws->length, probe.jaws->width,
                        probe.jaws->closed_below);
  return text;
}

}  // namespace palpate
