#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "common/describe/description.hpp"
#include "common/geometry/direction.hpp"

namespace palpate {

/// An electric scalpel: removes the dynamic tissue that the tip touches while the pedal is down.
struct Cautery {
  double radius = 0;  ///< [m] of the sphere that cuts, about the tip's centre; 0: the tip's
};

inline void describe(Description& d, Cautery& c) {
  d.number(
      {"radius", "m", "of the sphere that cuts, about the tip's centre", Need::optional, Use::agreed, "the tool's"},
      c.radius, above(0));
}

/// Two jaws of a probe that hold the tissue between them once closed.
struct ProbeJaws {
  double length = 0.012;      ///< [m] along the shaft
  double width = 0.006;       ///< [m] across the plane they open in
  double closed_below = 0.1;  ///< [rad] of grip
};

inline void describe(Description& d, ProbeJaws& j) {
  d.number(
      {"length", "m", "of what they hold, from the tip's centre onwards along the shaft; of a forceps of each jaw"},
      j.length, above(0));
  d.number({"width", "m", "of the same, across the shaft; of a probe alone"}, j.width, above(0));
  d.number({"closed_below", "rad", "of grip; of a probe alone"}, j.closed_below, above(0));
}

/// The jaws of a forceps, hinged at the tip's centre, each turned by half the opening.
struct ForcepsJaws {
  double length = 0.012;        ///< [m] of each
  double radius = 0.001;        ///< [m] of each about its segment
  double max_open = 1.0;        ///< [rad] between the jaws
  double grip_stiffness = 0.5;  ///< [N m/rad] of the handle's linkage: closing torque per angle beyond the touch
  double friction = 0.8;        ///< [1] between jaws and what they hold; beyond it the hold slips
};

inline void describe(Description& d, ForcepsJaws& j) {
  d.number(
      {"length", "m", "of what they hold, from the tip's centre onwards along the shaft; of a forceps of each jaw"},
      j.length, above(0));
  d.number({"radius", "m", "of each jaw about its segment; of a forceps alone, like the rest"}, j.radius, above(0));
  d.number({"max_open", "rad", "between the jaws; a trajectory whose grip is larger or negative is refused"},
           j.max_open, above_up_to(0, 2.5));
  d.number({"grip_stiffness", "N m/rad",
            "of the linkage: torque that closes the jaws per angle that the handle goes beyond the touch"},
           j.grip_stiffness, above(0));
  d.number({"friction", "1", "Coulomb's coefficient between the jaws and what they hold; beyond it the hold slips"},
           j.friction, at_least(0));
}

/// Spheres along tip and shaft.
struct ProbeSpec {
  static constexpr std::string_view kKind = "probe";
  double radius = 0.004;  ///< [m] of the spherical tip
  std::optional<Cautery> cautery;
  std::optional<ProbeJaws> jaws;
};

inline void describe(Description& d, ProbeSpec& p) {
  d.number({"radius", "m", "of a probe's spherical tip"}, p.radius, above(0));
  d.table({"cautery", "", "an electric scalpel; not for a forceps", Need::optional, Use::agreed, "cannot cut"},
          p.cautery);
  if (p.cautery && p.cautery->radius == 0) p.cautery->radius = p.radius;
  d.table({"jaws", "", "two jaws at the tip; needed for a forceps", Need::optional, Use::agreed, "cannot grasp"},
          p.jaws);
}

/// Segments of the shaft and of two jaws that open by the grip.
struct ForcepsSpec {
  static constexpr std::string_view kKind = "forceps";
  ForcepsJaws jaws;
};

inline void describe(Description& d, ForcepsSpec& f) {
  d.table({"jaws", "", "two jaws at the tip; needed for a forceps", Need::required}, f.jaws);
}

/// Moves a tool by a trajectory file.
struct ScriptedDeviceSpec {
  static constexpr std::string_view kKind = "scripted";
  std::filesystem::path trajectory;  ///< CSV
};

inline void describe(Description& d, ScriptedDeviceSpec& s) {
  d.file({"trajectory", "", "CSV for `\"scripted\"`, an LCM event log for `\"log\"`", Need::required, Use::local},
         s.trajectory);
}

/// Moves a tool as it moved in a recorded log.
struct LogDeviceSpec {
  static constexpr std::string_view kKind = "log";
  std::filesystem::path trajectory;  ///< LCM event log
};

inline void describe(Description& d, LogDeviceSpec& l) {
  d.file({"trajectory", "", "CSV for `\"scripted\"`, an LCM event log for `\"log\"`", Need::required, Use::local},
         l.trajectory);
}

/// A driver elsewhere publishes the tool's motion.
struct BusDeviceSpec {
  static constexpr std::string_view kKind = "bus";
};

inline void describe(Description&, BusDeviceSpec&) {}

class Device;
struct DevicePlace;

/// What programs ask of every kind of device: make_device(spec, place) makes it for a tool of a scene. Throws
/// std::runtime_error for a missing or malformed file.
std::unique_ptr<Device> make_device(const ScriptedDeviceSpec& spec, const DevicePlace& place);
std::unique_ptr<Device> make_device(const LogDeviceSpec& spec, const DevicePlace& place);
std::unique_ptr<Device> make_device(const BusDeviceSpec& spec, const DevicePlace& place);

/// The table of devices.
using DeviceSpec = std::variant<ScriptedDeviceSpec, LogDeviceSpec, BusDeviceSpec>;

/// An instrument about its trocar.
struct Tool {
  std::string name;
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();   ///< [m] trocar point, world frame
  Eigen::Vector3d axis = -Eigen::Vector3d::UnitZ();  ///< unit, direction of the shaft (handle to tip) in the zero pose
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();     ///< unit, perpendicular part used: the tool's y axis there
  double shaft_radius = 0.0025;                      ///< [m]
  double shaft_length = 0.3;                         ///< [m] from the tip back along the shaft
  std::variant<ProbeSpec, ForcepsSpec> end;
  double compliance = 1e-4;      ///< [m/N] of the instrument itself, against bodies with inertia in the haptic node
  double max_force = 10;         ///< [N] limit of the safety chain
  double max_force_rate = 5000;  ///< [N/s] slew limit
  DeviceSpec device;

  ProbeSpec* probe() { return std::get_if<ProbeSpec>(&end); }
  const ProbeSpec* probe() const { return std::get_if<ProbeSpec>(&end); }
  ForcepsSpec* forceps() { return std::get_if<ForcepsSpec>(&end); }
  const ForcepsSpec* forceps() const { return std::get_if<ForcepsSpec>(&end); }
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
  d.variant({"device", "",
             "`\"scripted\"`: a trajectory file; `\"log\"`: the tool's motion in a recorded log; `\"bus\"`: a driver "
             "elsewhere publishes it",
             Need::optional, Use::local},
            t.device);
  d.number({"compliance", "m/N",
            "of the instrument itself, where it meets bodies that move with inertia in the haptic node: shells and "
            "catheters"},
           t.compliance, above(0));
  d.number(
      {"max_force", "N",
       "limit of the force that goes to the hand; 0.3 m times it is that of the torque, and both are scaled alike"},
      t.max_force, above(0));
  d.number({"max_force_rate", "N/s", "limit of its change"}, t.max_force_rate, above(0));
  d.variant({"kind", "",
             "`\"probe\"`: spheres along tip and shaft; `\"forceps\"`: segments of the shaft and of two jaws that open "
             "by the grip"},
            t.end);
}

}  // namespace palpate
