#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>

#include "common/describe/description.hpp"
#include "common/describe/meanings.hpp"
#include "common/geometry/direction.hpp"
#include "common/tool/devices/device_spec.hpp"
#include "common/tool/ends/end_spec.hpp"
#include "common/tool/motion_limits.hpp"

namespace palpate {

/// An instrument about its trocar.
struct Tool {
  std::string name;
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();   ///< [m] trocar point, world frame
  Eigen::Vector3d axis = -Eigen::Vector3d::UnitZ();  ///< unit, direction of the shaft (handle to tip) in the zero pose
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();     ///< unit, perpendicular part used: the tool's y axis there
  double shaft_radius = 0.0025;                      ///< [m]
  double shaft_length = 0.3;                         ///< [m] from the tip back along the shaft
  ToolEndSpec end;
  double compliance = 1e-4;     ///< [m/N] of the instrument itself, against bodies with inertia in the haptic node
  double max_force = 10;        ///< [N] limit of the safety chain
  double max_force_rate = 250;  ///< [N/s] at which the force changes at most
  double force_scale = 1;       ///< [1] of its forces that the hand gets, before the limits
  MotionLimits motion;          ///< that its device must keep to
  DeviceSpec device;
};

inline const std::string& name_of(const Tool& tool) {
  return tool.name;
}

inline void describe(Description& d, Tool& t) {
  d.name({"name", "", "as for a body; different for each tool", Need::required}, t.name);
  d.vector({"pivot", "m", "the trocar point", Need::required}, t.pivot);
  d.direction({"axis", "", "direction of the shaft in the zero pose, from handle to tip; its length does not matter"},
              t.axis);
  if (!d.given("up") && parallel(t.axis, t.up)) t.up = Eigen::Vector3d::UnitZ();
  d.direction({"up", "",
               "the tool's y axis in the zero pose, made perpendicular to `axis`; `[0, 0, 1]` is the default where "
               "`axis` is along y"},
              t.up);
  d.require(!parallel(t.axis, t.up), "up", "up must not be parallel to the tool's axis");
  d.number({"shaft_radius", "m", "of the shaft"}, t.shaft_radius, above(0));
  d.number({"shaft_length", "m", "from the tip back along the shaft"}, t.shaft_length, above(0));
  static const std::string devices = meanings(std::type_identity<DeviceSpec>{});
  d.variant({"device", "", devices, Need::optional, Use::local}, t.device);
  d.number({"compliance", "m/N",
            "of the instrument itself, where it meets bodies that move with inertia in the haptic node: shells and "
            "catheters"},
           t.compliance, above(0));
  d.number(
      {"max_force", "N",
       "limit of the force that goes to the hand; 0.3 m times it is that of the torque, and both are scaled alike"},
      t.max_force, above(0));
  d.number({"max_force_rate", "N/s",
            "at which it rises, falls or turns at most; one that pushes a hand which moves away falls faster"},
           t.max_force_rate, above(0));
  d.number({"force_scale", "",
            "share of the tool's forces and torques that goes to the hand; the limits hold for what is left"},
           t.force_scale, within(1e-3, 1e3));
  d.table({"motion", "", "what its device may ask for", Need::optional, Use::agreed, "defaults"}, t.motion);
  static const std::string ends = meanings(std::type_identity<ToolEndSpec>{});
  d.variant({"kind", "", ends}, t.end);
}

}  // namespace palpate
