#pragma once
#include <array>
#include <span>

#include "common/tool/tool_part.hpp"

namespace palpate {

/// A laparoscopic forceps as three segments that meet at the joint point J (BHS01 sec. V-A): the shaft and two jaws. J
/// is the origin of the tip frame; the shaft runs back along -z, the jaws turn in the plane x = 0.
struct ForcepsShape {
  double shaft_radius = 0.0025, shaft_length = 0.3;  ///< [m]
  double jaw_length = 0.012, jaw_radius = 0.001;     ///< [m]
};

/// Places of the parts.
enum ForcepsPart : int { forceps_shaft = 0, forceps_jaw_a = 1, forceps_jaw_b = 2 };
inline constexpr int kForcepsPartCount = 3;

/// Parts for an opening [rad] between the jaws: from J the shaft along -z, jaw A along (0, sin(opening/2),
/// cos(opening/2)), jaw B along (0, -sin(opening/2), cos(opening/2)).
std::array<ToolPart, kForcepsPartCount> forceps_parts(const ForcepsShape& shape, double opening);

/// Turns the jaws of existing parts; allocates nothing.
void set_opening(double opening, std::span<ToolPart> parts);

/// Whether a point in the tip frame [m] lies between the jaws: in their wedge, no farther to the side than their
/// radius, and from J on no farther than their length.
bool between_jaws(const ForcepsShape& shape, double opening, const Eigen::Vector3d& p);

}  // namespace palpate
