#include "common/models/catheter/sleeve.hpp"

#include <stdexcept>

#include "common/models/catheter/grasps.hpp"

namespace palpate {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Sleeve::Sleeve(const Vector3d& tail, const Vector3d& tip, double length)
    : tail_(tail), axis_((tip - tail).normalized()), length_(length) {
  if (length < 0) throw std::runtime_error("the catheter's sleeve must not have a negative length");
  if (length >= (tip - tail).norm())
    throw std::runtime_error("the catheter's sleeve must be shorter than the catheter");
}

void Sleeve::hold(const ChainPoint& point, std::span<const Vector3d> x, const Matrix3d& stiffness, BandMatrix& matrix,
                  std::span<double> right_side, const Vector3d& at) const {
  add_at_point(point, stiffness, matrix);
  add_at_point(point, Vector3d(stiffness * (at - place_of(point, x))), right_side);
}

void Sleeve::add_springs(std::span<const Vector3d> x, BandMatrix& matrix, std::span<double> right_side) const {
  if (length_ == 0) return;
  const Matrix3d along = axis_ * axis_.transpose() / kCompliance;
  const Matrix3d across = Matrix3d::Identity() / kCompliance - along;
  const int last = static_cast<int>(x.size()) - 1;
  double depth = axis_.dot(x[0] - tail_) - length_;
  if (depth > 0) hold({0, 0}, x, along, matrix, right_side, tail_ + length_ * axis_);
  hold({0, 0}, x, across, matrix, right_side, tail_);
  for (int i = 1; i <= last; ++i) {
    const double next = axis_.dot(x[i] - tail_) - length_;
    if (next > 0) {
      if (depth < 0) hold({i - 1, -depth / (next - depth)}, x, across, matrix, right_side, tail_);
      return;
    }
    hold({i - 1, 1}, x, across, matrix, right_side, tail_);
    depth = next;
  }
}

}  // namespace palpate
