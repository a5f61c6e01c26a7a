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

  /// Throws std::runtime_error where a step is not possible there, such as a press before a place, or a force that is
  /// not reached.
  void add(const MotionStep& step);

  struct Part {
    std::string text;
    double begin, end;  ///< [s]
  };
  const std::vector<Part>& parts() const { return parts_; }
  const MotionRows& rows() const { return *rows_; }

 private:
  void go_to(const Eigen::Vector3d& place);
  void press(double depth);
  void slide(const Eigen::Vector3d& place);
  double depth_for(double force) const;
  SurfacePlace place_near(const Eigen::Vector3d& point) const;
  Eigen::Vector3d tip_at(const SurfacePlace& place, double depth) const { return centre_at(place, radius_, depth); }

  SmoothSurface surface_;
  std::vector<int> triangles_;  ///< that can be touched
  const Rehearsal& rehearsal_;
  MotionManner manner_;
  Trocar trocar_;
  double radius_;
  std::optional<MotionRows> rows_;     ///< empty before the first place
  std::optional<SurfacePlace> place_;  ///< where it is
  double depth_ = 0;                   ///< [m] negative: clear of the surface
  std::vector<Part> parts_;
};

}  // namespace palpate
