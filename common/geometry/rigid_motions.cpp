#include "common/geometry/rigid_motions.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "common/geometry/dense_solvers.hpp"

namespace palpate {

RigidMotions::RigidMotions(const std::vector<Eigen::Vector3d>& places) : centre_(Eigen::Vector3d::Zero()), size_(0) {
  for (const Eigen::Vector3d& p : places) centre_ += p;
  centre_ /= static_cast<double>(places.size());
  for (const Eigen::Vector3d& p : places) size_ = std::max(size_, (p - centre_).norm());
}

void RigidMotions::hold(const Eigen::Vector3d& place, int axis) {
  Eigen::Matrix<double, 6, 1> row;
  row << Eigen::Vector3d::Unit(axis), ((place - centre_) / size_).cross(Eigen::Vector3d::Unit(axis));
  gram_ += row * row.transpose();
}

void RigidMotions::hold_rotation(int axis) {
  gram_(3 + axis, 3 + axis) += 1;
}

int RigidMotions::free() const {
  const Eigen::VectorXd values = symmetric_eigenvalues(gram_);
  return static_cast<int>((values.array() <= 1e-10 * values.maxCoeff()).count());  // they are squares
}

}  // namespace palpate
