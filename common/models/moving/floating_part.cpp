#include "common/models/moving/floating_part.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace palpate {

using Eigen::Affine3d;
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

bool FloatingPart::is_held_by(const JawHold& hold) const {
  return std::ranges::find(nodes_, hold.anchor.nodes[0]) != nodes_.end();
}

void FloatingPart::give_back_damping(DynamicModel& model, std::span<const Vector3d> rest, std::span<const JawHold> held,
                                     double dt) {
  int count = 0;
  Affine3d velocity(Affine3d::MatrixType::Zero());  // [m/s] of each place [m], as the mean of the jaws takes it along
  for (const JawHold& hold : held) {
    if (!is_held_by(hold)) continue;
    ++count;
    velocity.affine() += (hold.motion.matrix() - Eigen::Matrix4d::Identity()).topRows<3>() / dt;
  }
  if (count == 0) return go_on(model, rest);
  velocity.affine() /= count;
  const Vector3d braking = go_along(model, rest, velocity);
  for (const JawHold& hold : held)
    for (int v = 0; v < 3 && is_held_by(hold); ++v) {
      const int n = hold.anchor.nodes[v];
      model.set_load(n, model.load(n) - hold.anchor.weights[v] / count * braking);
    }
}

// With jaws. Returns what brakes all of it against them [N].
Vector3d FloatingPart::go_along(DynamicModel& model, std::span<const Vector3d> rest, const Affine3d& velocity) {
  Vector3d braking = Vector3d::Zero();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const int n = nodes_[i];
    const double rate = damping_ * model.mass(n);
    const Vector3d along = velocity * Vector3d(rest[n] + model.displacement(n));
    braking -= rate * (model.velocity(n) - along);
    model.set_load(n, load_[i] + rate * along);
  }
  return braking;
}

// As a rigid body.
void FloatingPart::go_on(DynamicModel& model, std::span<const Vector3d> rest) {
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
