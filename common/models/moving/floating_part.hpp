#pragma once
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "common/dynamics/dynamic_model.hpp"
#include "common/geometry/anchor.hpp"

namespace palpate {

/// A point of the tissue that jaws hold, and how these move within a step of it.
struct JawHold {
  Anchor anchor;
  Eigen::Isometry3d motion;  ///< world, from the step's beginning to its end
};

/// A part of moving tissue that hangs on nothing. Damping in proportion to mass brakes tissue against the room; of what
/// floats it is to brake the swinging alone. So its motion as a rigid body, the mean velocity and the turn that have
/// its momentum and angular momentum, is given back by loads, whose sum and moment are what damping takes of the whole.
/// What jaws carry is tissue that hangs on them: it is braked against them and not against the room, so that it comes
/// to rest between them, and what brakes it pushes the points that they hold the other way. So they feel its weight and
/// its inertia and nothing else.
class FloatingPart {
 public:
  /// `nodes`: of its tetrahedra, each once. `damping` [1/s] of the model.
  FloatingPart(std::vector<int> nodes, double damping);

  const std::vector<int>& nodes() const { return nodes_; }
  /// Takes all loads from its nodes.
  void unload(DynamicModel& model) const;
  /// What loads its nodes now loads them until unload(), beside the damping that is given back.
  void keep_loads(const DynamicModel& model);
  /// Before each step of `dt` [s] of the tissue: loads for the rigid motion that there is. `rest` [m] per node of the
  /// body; `held`: all that jaws hold of it. Over a step h an acceleration loses damping h / 2 of its size in a
  /// Runge-Kutta step, nothing in a semi-implicit one.
  void give_back_damping(DynamicModel& model, std::span<const Eigen::Vector3d> rest, std::span<const JawHold> held,
                         double dt);

 private:
  bool is_held_by(const JawHold& hold) const;
  void go_on(DynamicModel& model, std::span<const Eigen::Vector3d> rest);
  Eigen::Vector3d go_along(DynamicModel& model, std::span<const Eigen::Vector3d> rest, const Eigen::Affine3d& velocity);

  std::vector<int> nodes_;
  double damping_;
  std::vector<Eigen::Vector3d> load_, at_;  ///< [N]; [m] from its first node: per node of nodes_
};

}  // namespace palpate
