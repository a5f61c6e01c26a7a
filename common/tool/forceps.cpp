#include "common/tool/forceps.hpp"

#include <cmath>

namespace palpate {
namespace {

/// Turns z towards +y by the angle [rad].
Eigen::Matrix3d tilted(double angle) {
  return Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitX()).toRotationMatrix();
}

}  // namespace

std::array<ToolPart, kForcepsPartCount> forceps_parts(const ForcepsShape& shape, double opening) {
  std::array<ToolPart, kForcepsPartCount> parts;
  parts[forceps_shaft] = {.length = shape.shaft_length, .radius = shape.shaft_radius};
  parts[forceps_shaft].pose.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  parts[forceps_jaw_a] = parts[forceps_jaw_b] = {.length = shape.jaw_length, .radius = shape.jaw_radius};
  set_opening(opening, parts);
  return parts;
}

void set_opening(double opening, std::span<ToolPart> parts) {
  parts[forceps_jaw_a].pose.linear() = tilted(0.5 * opening);
  parts[forceps_jaw_b].pose.linear() = tilted(-0.5 * opening);
}

bool between_jaws(const ForcepsShape& shape, double opening, const Eigen::Vector3d& p) {
  const double from_joint = std::hypot(p.y(), p.z());
  return std::abs(p.x()) <= shape.jaw_radius && from_joint <= shape.jaw_length &&
         std::abs(std::atan2(p.y(), p.z())) <= 0.5 * opening;
}

}  // namespace palpate
