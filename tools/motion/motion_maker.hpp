#pragma once
#include <optional>
#include <string>
#include <vector>

#include "common/contact/patch/surface_place.hpp"
#include "tools/motion/motion_rows.hpp"
#include "tools/motion/motion_step.hpp"
#include "tools/motion/rehearsal.hpp"

namespace palpate {

struct MotionManner {
  double speed = 0.03;  ///< [m/s] of the tip, at most
  double clear = 0.02;  ///< [m] between tip and tissue where it does not press
};

/// Makes a tool's motion of its steps.
class MotionMaker {
 public:
  /// `map`: of the body that is touched; it and `rehearsal` outlive this object.
  MotionMaker(const Tool& tool, const SurfaceMap& map, const Rehearsal& rehearsal, const MotionManner& manner);

  /// Adds steps, of which none is tried before all have been looked at. Throws std::runtime_error where one is not
  /// possible there, such as a press before a place, or a force that is not reached.
  void add(const std::vector<MotionStep>& steps);

  struct Part {
    MotionStep step;
    double begin, end;  ///< [s]
  };
  const std::vector<Part>& parts() const { return parts_; }
  const MotionRows& rows() const { return *rows_; }

 private:
  /// What a tool feels at every step of the scene's time on a way.
  struct Pass {
    std::vector<double> depth, force;  ///< [m], [N]
  };
  /// What it feels when it arrives at a depth, and after it has stood there.
  struct Press {
    double arriving, standing;  ///< [N]
  };
  struct Guess {
    double depth, slope;  ///< [m]; [N/m] of the force there
  };

  void look_at(const MotionStep& step) const;
  void try_and_add(const MotionStep& step);
  void go_to(const Eigen::Vector3d& place);
  void press(double depth);
  void slide(const Eigen::Vector3d& place);
  void press_with(double force);
  Pass pass_to(double depth) const;
  Press press_at(double depth) const;
  Guess guess_for(double force) const;
  SurfacePlace place_near(const Eigen::Vector3d& point) const;
  Eigen::Vector3d tip_at(const SurfacePlace& place, double depth) const { return centre_at(place, radius_, depth); }

  SmoothSurface surface_;
  std::vector<int> triangles_;  ///< that can be touched
  const Rehearsal& rehearsal_;
  MotionManner manner_;
  Trocar trocar_;
  double reach_;  ///< [m] from the tip frame's origin to where the tool touches first
  double radius_;
  double deepest_press_;  ///< [m] the body's box from corner to corner
  bool has_jaws_;
  std::optional<double> widest_jaws_;  ///< [rad] of jaws that turn
  std::optional<MotionRows> rows_;     ///< empty before the first place
  std::optional<SurfacePlace> place_;  ///< where it is
  double depth_ = 0;                   ///< [m] negative: clear of the surface
  std::vector<Part> parts_;
};

}  // namespace palpate
