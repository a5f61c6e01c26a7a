#include "common/tool/ends/forceps.hpp"

#include <fmt/format.h>

#include "common/tool/instrument.hpp"

namespace palpate {

EndAbilities abilities(const ForcepsSpec& forceps) {
  return {.radius = forceps.jaws.radius,
          .radius_of = "jaws with a radius",
          .ball = {},
          .turning = forceps.jaws,
          .holding = {forceps_jaw_a, kForcepsPartCount}};
}

std::vector<ToolPart> end_parts(const ForcepsSpec&, const Tool& tool, double opening) {
  const auto parts = forceps_parts(*forceps_shape(tool), opening);
  return {parts.begin(), parts.end()};
}

std::string sentence(const ForcepsSpec& forceps, const Tool& tool) {
  const TurningJaws& jaws = forceps.jaws;
  return fmt::format(
      "tool '{}': forceps, jaws of {} m that open from 0 to {} rad, linkage {} N m/rad, friction {}, compliance {} m/N",
      tool.name, jaws.length, jaws.max_open, jaws.grip_stiffness, jaws.friction, tool.compliance);
}

}  // namespace palpate
