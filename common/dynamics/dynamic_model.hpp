#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "common/describe/state.hpp"
#include "common/dynamics/integrator.hpp"

namespace palpate {

/// Linear forces that other parts of a body exert on some nodes of a dynamic model, such as the quasi-static part of
/// a hybrid organ through its connection nodes: force = constant - B u over the coupled nodes.
class Coupling {
 public:
  virtual ~Coupling() = default;
  /// Adds -B u to `force`; u and force have three entries per coupled node, in the order given to couple(). Linear and
  /// symmetric; called in every stage. The constant part comes through DynamicModel::set_load().
  virtual void apply(const double* u, double* force) = 0;
};

/// Moving tissue of one body: M u'' + a M u' + f_elastic(u) = load. Nodes and tetrahedra are those of the ElasticMesh
/// it was built from. A node without a tetrahedron and without added mass (see couple) stands still and takes no force.
/// Displacements of fixed axes stay zero. All arrays are taken at construction: step() and remove() allocate nothing.
class DynamicModel : public Stateful<DynamicModel> {
 public:
  virtual ~DynamicModel() = default;

  /// Upper bound of the undamped angular frequencies [rad/s], from the remaining elements and the coupling.
  virtual double frequency_bound() const = 0;
  /// One step of `dt` [s]: every node's u and v go on; loads stay constant within a step.
  virtual void step(double dt) = 0;
  /// The same by the semi-implicit rule, whatever the model's own: a force f that is known only after it still counts
  /// as if it had acted within it, by dt f/m on the velocity and dt^2 f/m on the displacement.
  virtual void step_semi_implicit(double dt) = 0;
  /// Takes tetrahedra out of the model: forces and masses become those of the remaining ones alone, bit for bit as if
  /// built afresh from them.
  virtual void remove(std::span<const int> tetrahedra) = 0;

  /// Couples the nodes to others' forces; null: none. `mass` [kg] per coupled node is added to the lumped mass;
  /// `bound` [rad^2/s^2] is at least the largest eigenvalue of B against that added mass alone, so that no frequency of
  /// the whole lies above the greater of it and the elements' own.
  virtual void couple(Coupling* coupling, std::span<const int> nodes, std::span<const double> mass, double bound) = 0;

  virtual Eigen::Vector3d displacement(int node) const = 0;  ///< [m]
  virtual Eigen::Vector3d velocity(int node) const = 0;      ///< [m/s]
  virtual void set_motion(int node, const Eigen::Vector3d& u, const Eigen::Vector3d& v) = 0;
  virtual double mass(int node) const = 0;  ///< [kg] lumped; 0 without tetrahedra
  /// External force [N] on a node, gravity included or not as the caller likes; stays until set again.
  virtual void set_load(int node, const Eigen::Vector3d& force) = 0;
  virtual Eigen::Vector3d load(int node) const = 0;
  /// Elastic force [N] that the tissue exerts on a node at its present displacement: -dW/du.
  virtual Eigen::Vector3d elastic_force(int node) const = 0;
  /// Elastic and kinetic energy [J], coupling excluded.
  virtual double energy() const = 0;
  virtual int nodes() const = 0;

  /// What it remembers from step to step, u and v of all nodes first: for keyframes and state hashes. Its size never
  /// changes.
  virtual void state(State& s) = 0;
};

/// Largest stable step [s] for angular frequencies up to `bound` [rad/s] and mass-proportional damping a [1/s].
/// Undamped: 2 sqrt(2)/bound (RK4), 2/bound (semi-implicit); forward Euler is only stable with damping.
double max_step(Integrator integrator, double bound, double damping);

}  // namespace palpate
