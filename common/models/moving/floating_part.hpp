#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/dynamics/dynamic_model.hpp"

namespace palpate {

/// A part of moving tissue that hangs on nothing. Damping in proportion to mass brakes tissue against the room; of what
/// floats it is to brake the swinging alone. So its motion as a rigid body, the mean velocity and the turn that have
/// its momentum and angular momentum, is given back by loads, whose sum and moment are what damping takes of the whole.
class FloatingPart {
 public:
  /// `nodes`: of its tetrahedra, each once. `damping` [1/s] of the model.
  FloatingPart(std::vector<int> nodes, double damping);

  const std::vector<int>& nodes() const { return nodes_; }
  /// Takes all loads from its nodes.
  void unload(DynamicModel& model) const;
  /// What loads its nodes now loads them until unload(), beside the damping that is given back.
  void keep_loads(const DynamicModel& model);
  /// Before each step of the tissue: loads for the rigid motion that there is. `rest` [m] per node of the body. Over a
  /// step h an acceleration loses damping h / 2 of its size in a Runge-Kutta step, nothing in a semi-implicit one.
  void give_back_damping(DynamicModel& model, std::span<const Eigen::Vector3d> rest);

 private:
  std::vector<int> nodes_;
  double damping_;
  std::vector<Eigen::Vector3d> load_, at_;  ///< [N]; [m] from its first node: per node of nodes_
};

}  // namespace palpate
