#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/dynamics/resection.hpp"
#include "common/sim/handling.hpp"
#include "common/sim/simulator.hpp"

namespace palpate::drive {

/// One number that a run comes to.
struct Figure {
  std::string name;  ///< "tool.probe.force.max"
  double value = 0;
  std::string unit;
};
using Figures = std::vector<Figure>;

/// The figure of that name. A name without that of a tool or body means the largest of theirs: "tool.force.max". Empty
/// if there is none.
std::optional<Figure> find(const Figures& figures, const std::string& name);

/// "tool.force.max" for "tool.probe.force.max"; empty for a figure that is of no tool or body.
std::string without_owner(const std::string& name);

/// Follows a simulator and says what its run comes to.
class Watch {
 public:
  /// `archives`: as the simulator got them.
  Watch(const sim::Simulator& simulator, const std::vector<Archive>& archives);

  void look(sim::Simulator& simulator);  ///< at the step that has just been made
  /// Of what was looked at; docs/drive.md lists them.
  Figures figures(const sim::Simulator& simulator) const;

 private:
  struct OfTool {
    Handling handling;
    double max_force = 0, last_force = 0, max_torque = 0, max_grip = 0;
    std::uint64_t limited = 0, faults = 0;
  };
  struct OfBody {
    std::vector<Eigen::Vector3f> rest;  ///< [m] per node of the surface map, from the origin of SurfaceView on
    double max_displacement = 0, last_displacement = 0;
    std::uint64_t cut = 0, torn = 0, fallen = 0;
    std::optional<Resection> resection;  ///< where the scene marks what is to be cut off
  };

  void look_at_tool(const sim::Simulator& simulator, int tool);
  void look_at_body(sim::Simulator& simulator, int body);

  std::vector<OfTool> tools_;
  std::vector<OfBody> bodies_;
  std::uint64_t steps_ = 0, shape_interval_;
  double min_energy_ = 0;
  bool finite_ = true;
};

}  // namespace palpate::drive
