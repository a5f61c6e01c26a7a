#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/tool/cautery.hpp"
#include "common/tool/jaws_spec.hpp"
#include "common/tool/tool_part.hpp"

namespace palpate {

class ToolEnd;
struct EndPlace;
struct Tool;

/// Which parts of a tool feel what its jaws hold: from `first` up to `end`.
struct JawParts {
  int first = 0, end = 1;
};

/// What an instrument can do, and how it meets tissue, by what is at its end.
struct EndAbilities {
  double radius;                            ///< [m] of what meets tissue first
  std::string_view radius_of;               ///< in a sentence: "a radius"
  std::optional<double> ball;               ///< [m] radius of a spherical tip, behind which spheres make the shaft
  std::optional<Cautery> cautery = {};      ///< cuts
  std::optional<ClosingJaws> closing = {};  ///< jaws that hold what is between them once closed
  std::optional<TurningJaws> turning = {};  ///< jaws that turn until they touch
  JawParts holding = {};

  bool works() const { return cautery || closing || turning; }  ///< beside pressing
};

/// What programs ask of every kind of end are functions of its spec, declared beside it. Programs call them by
/// std::visit on a ToolEndSpec or through common/tool/instrument.hpp, and know of no kind otherwise.
///
/// abilities(spec): what it can do.
///
/// end_parts(spec, tool, opening): its parts for collision, the shaft's included. `opening` [rad]: between jaws that
/// turn.
///
/// sentence(spec, tool): what a check says of the tool.
///
/// make_tool_end(spec, place): it under the hand, in the haptic step.

}  // namespace palpate
