#pragma once
#include <vector>

#include "common/contact/body_part.hpp"
#include "common/geometry/triangle.hpp"

namespace palpate {

/// What of a surface lies between the jaws of a forceps: where the plane in which they turn cuts its triangles, edge by
/// edge, since nodes alone would miss what passes between them. Allocates nothing after construction.
class JawObstacles {
 public:
  JawObstacles() { obstacles_.reserve(kMax); }

  /// `radius` [m] by which tissue reaches out from the surface: half the thickness of a wall.
  void begin(const OpenJaws& jaws, double radius);
  void add(const Triangle& corners);
  BetweenJaws found() const;

 private:
  static constexpr std::size_t kMax = 512;

  const OpenJaws* jaws_ = nullptr;  ///< from begin() to found()
  double radius_ = 0, distance_ = 0;
  Eigen::Isometry3d to_tip_ = Eigen::Isometry3d::Identity();
  std::vector<GripObstacle> obstacles_;
};

}  // namespace palpate
