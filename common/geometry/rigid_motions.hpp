#pragma once
#include <Eigen/Core>
#include <vector>

namespace palpate {

/// Which of a body's six rigid-body motions are left free by what is held of it.
class RigidMotions {
 public:
  /// Of a body that has these places [m].
  explicit RigidMotions(const std::vector<Eigen::Vector3d>& places);

  void hold(const Eigen::Vector3d& place, int axis);  ///< the displacement there along x, y or z
  void hold_rotation(int axis);
  /// How many are free: six less the rank of the rows that the motions (a translation, and a rotation about the middle
  /// times the body's size) have at what is held. Points within 1e-5 of the size count as one.
  int free() const;

 private:
  Eigen::Vector3d centre_;
  double size_;
  Eigen::Matrix<double, 6, 6> gram_ = Eigen::Matrix<double, 6, 6>::Zero();
};

}  // namespace palpate
