#include "common/models/catheter/grasps.hpp"

#include <cmath>

namespace palpate {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void add_at_point(const ChainPoint& p, const Matrix3d& block, BandMatrix& matrix) {
  const double b = p.along, a = 1 - b;
  matrix.add(p.segment, 0, a * a * block);
  if (b == 0) return;
  matrix.add(p.segment, 1, a * b * block);
  matrix.add(p.segment + 1, 0, b * b * block);
}

void add_at_point(const ChainPoint& p, const Vector3d& force, std::span<double> right_side) {
  for (int axis = 0; axis < 3; ++axis) {
    right_side[3 * p.segment + axis] += (1 - p.along) * force[axis];
    right_side[3 * p.segment + 3 + axis] += p.along * force[axis];
  }
}

bool Grasps::holds_near(int tool, int segment) const {
  if (!holds(tool)) return false;
  const Grasp& grasp = grasps_[tool];
  int low = grasp.held[0].point.segment, high = low;
  for (int i = 1; i < grasp.count; ++i) {
    low = std::min(low, grasp.held[i].point.segment);
    high = std::max(high, grasp.held[i].point.segment);
  }
  return segment >= low - 1 && segment <= high + 1;
}

void Grasps::add(int tool, const ChainPoint& point, const Vector3d& place, const Eigen::Isometry3d& jaw) {
  Grasp& grasp = grasps_.at(tool);
  if (grasp.count == kMaxPoints) return;
  Held held;
  held.point = point;
  held.in_jaw = jaw.inverse() * place;
  held.target = held.next = place;
  grasp.held[grasp.count++] = held;
}

void Grasps::let_go(int tool) {
  if (tool >= 0 && tool < tools()) grasps_[tool] = {};
}

double Grasps::load(int tool) const {
  if (!holds(tool)) return 0;
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < grasps_[tool].count; ++i) sum += grasps_[tool].held[i].force;
  return sum.norm();
}

void Grasps::begin(std::span<const Eigen::Isometry3d> jaws) {
  for (int tool = 0; tool < tools(); ++tool)
    for (int i = 0; i < grasps_[tool].count; ++i) {
      Held& held = grasps_[tool].held[i];
      held.next = tool < static_cast<int>(jaws.size()) ? Vector3d(jaws[tool] * held.in_jaw) : held.target;
      held.force.setZero();
    }
}

void Grasps::add_springs(std::span<const Vector3d> x, double left, BandMatrix& matrix,
                         std::span<double> right_side) const {
  for (const Grasp& grasp : grasps_)
    for (int i = 0; i < grasp.count; ++i) {
      const Held& held = grasp.held[i];
      const Vector3d target = left * held.target + (1 - left) * held.next;
      add_at_point(held.point, grasp.stiffness * Matrix3d::Identity(), matrix);
      add_at_point(held.point, Vector3d(grasp.stiffness * (target - place_of(held.point, x))), right_side);
    }
}

void Grasps::add_forces(std::span<const Vector3d> x, double left, double share) {
  for (Grasp& grasp : grasps_)
    for (int i = 0; i < grasp.count; ++i) {
      Held& held = grasp.held[i];
      const Vector3d target = left * held.target + (1 - left) * held.next;
      held.force += share * grasp.stiffness * (target - place_of(held.point, x));
    }
}

void Grasps::end() {
  for (Grasp& grasp : grasps_)
    for (int i = 0; i < grasp.count; ++i) grasp.held[i].target = grasp.held[i].next;
}

}  // namespace palpate
