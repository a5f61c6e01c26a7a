#include "common/contact/jaw_obstacles.hpp"

namespace palpate {

void JawObstacles::begin(const OpenJaws& jaws, double radius) {
  jaws_ = &jaws;
  radius_ = radius;
  to_tip_ = jaws.pose.inverse();
  distance_ = 0;
  obstacles_.clear();
}

void JawObstacles::add(const Triangle& corners) {
  const std::array<Eigen::Vector3d, 3> p{to_tip_ * corners[0], to_tip_ * corners[1], to_tip_ * corners[2]};
  for (int v = 0; v < 3; ++v) {
    const Eigen::Vector3d &a = p[v], &b = p[(v + 1) % 3];
    if ((a.x() < 0) == (b.x() < 0) || obstacles_.size() == kMax) continue;
    const Eigen::Vector3d cut = a + a.x() / (a.x() - b.x()) * (b - a);
    if (cut.z() <= 0 || cut.z() > jaws_->shape.jaw_length) continue;
    obstacles_.push_back({cut, radius_});
    distance_ += cut.z();
  }
}

BetweenJaws JawObstacles::found() const {
  if (obstacles_.empty()) return {};
  return {opening_at_contact(jaws_->shape, obstacles_, jaws_->opening),
          distance_ / static_cast<double>(obstacles_.size())};
}

}  // namespace palpate
