#include "common/models/moving/floating_part.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <utility>

namespace palpate {

using Eigen::Matrix3d;
using Eigen::Vector3d;

FloatingPart::FloatingPart(std::vector<int> nodes, double damping)
    : nodes_(std::move(nodes)),
      damping_(damping),
      load_(nodes_.size(), Vector3d::Zero()),
      at_(nodes_.size(), Vector3d::Zero()) {}

void FloatingPart::unload(DynamicModel& model) const {
  for (const int n : nodes_) model.set_load(n, Vector3d::Zero());
}

void FloatingPart::keep_loads(const DynamicModel& model) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) load_[i] = model.load(nodes_[i]);
}

void FloatingPart::give_back_damping(DynamicModel& model, std::span<const Vector3d> rest) {
  const auto place = [&](int n) -> Vector3d { return rest[n] + model.displacement(n); };
  const Vector3d origin = place(nodes_[0]);
  double mass = 0;
  Vector3d moment = Vector3d::Zero(), momentum = moment;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const double m = model.mass(nodes_[i]);
    at_[i] = place(nodes_[i]) - origin;
    mass += m;
    moment += m * at_[i];
    momentum += m * model.velocity(nodes_[i]);
  }
  const Vector3d centre = moment / mass, mean = momentum / mass;
  Matrix3d inertia = Matrix3d::Zero();
  Vector3d angular = Vector3d::Zero();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const double m = model.mass(nodes_[i]);
    at_[i] -= centre;
    inertia += m * (at_[i].squaredNorm() * Matrix3d::Identity() - at_[i] * at_[i].transpose());
    angular += m * at_[i].cross(model.velocity(nodes_[i]));
  }
  const Vector3d turn = inertia.ldlt().solve(angular);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const int n = nodes_[i];
    model.set_load(n, load_[i] + damping_ * model.mass(n) * (mean + turn.cross(at_[i])));
  }
}

}  // namespace palpate
