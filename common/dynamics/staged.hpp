#pragma once
#include "common/dynamics/dynamic_model.hpp"
#include "common/dynamics/elastic_mesh.hpp"
#include "common/kernels/kernels.hpp"

namespace palpate {

/// A dynamic model whose elastic force may be any function of the displacements. It is evaluated afresh in
/// every stage of the integrator; models only say what it is. Masses are lumped: a tetrahedron gives each
/// corner rho V / 4.
///
/// Nodes have four entries each, x y z 0, as the kernels take them. elastic_force() computes the whole field
/// once after each change and keeps it.
template <class Scalar>
class Staged : public DynamicModel {
 public:
  /// [m/s^2]; acts on the tetrahedra's own mass beside the loads, and follows that mass through removals.
  void set_gravity(const Eigen::Vector3d& gravity);

  void step(double dt) final;
  void step_semi_implicit(double dt) final;
  void remove(std::span<const int> tetrahedra) final;
  void couple(Coupling* coupling, std::span<const int> nodes, std::span<const double> mass, double bound) final;
  double frequency_bound() const final;

  Eigen::Vector3d displacement(int node) const final { return entry(u(), node); }
  Eigen::Vector3d velocity(int node) const final { return entry(v(), node); }
  void set_motion(int node, const Eigen::Vector3d& u, const Eigen::Vector3d& v) final;
  double mass(int node) const final { return mass_[node] > 0 ? mass_[node] + coupled_mass_[node] : 0; }
  void set_load(int node, const Eigen::Vector3d& force) final;
  Eigen::Vector3d load(int node) const final { return load_[node]; }
  Eigen::Vector3d elastic_force(int node) const final;
  double energy() const final;
  int nodes() const final { return static_cast<int>(mass_.size()); }
  /// A model with memory of its own adds it to this.
  void state(State& s) override;

  bool alive(int tetrahedron) const { return alive_[tetrahedron]; }

 protected:
  using Array = std::vector<Scalar, kernels::LineAllocator<Scalar>>;

  /// `damping` [1/s] is a of M u'' + a M u'. Throws std::runtime_error where a tetrahedron has no positive
  /// volume.
  Staged(const ElasticMesh& mesh, Integrator integrator, double damping);

  /// Adds the elastic force [N] of every node at displacements `u` [m].
  virtual void add_forces(const Scalar* u, Scalar* force) const = 0;
  /// [J] at the present displacements.
  virtual double elastic_energy() const = 0;
  /// Takes one tetrahedron out of the elastic forces; alive() says so already.
  virtual void take_out(int tetrahedron) = 0;
  /// At the end of a step of `dt` [s], which moved the nodes to `u`: what the model remembers beside them goes on.
  virtual void remember(const Scalar* /*u*/, Scalar /*dt*/) {}

  /// The model's element bounds [rad^2/s^2], one per tetrahedron; the largest of the remaining ones counts.
  void set_element_bounds(std::vector<double> square) { element_bound_ = std::move(square); }
  int size() const { return static_cast<int>(tetrahedra_.size()); }
  const std::array<int, 4>& tetrahedron(int t) const { return tetrahedra_[t]; }

  const kernels::Table& kernels_ = kernels::active();  // chosen once: the choice takes memory

 private:
  const Scalar* u() const { return state_.data(); }
  const Scalar* v() const { return state_.data() + state_.size() / 2; }
  Scalar* u() { return state_.data(); }
  Scalar* v() { return state_.data() + state_.size() / 2; }
  static Eigen::Vector3d entry(const Scalar* field, int node) {
    return Eigen::Map<const Eigen::Matrix<Scalar, 3, 1>>(field + 4 * node).template cast<double>();
  }
  void sum_mass(int node);
  void set_inverse_mass(int node);
  void sum_load(int node);
  void sum_forces(const Scalar* u);
  void add_coupling(const Scalar* u);
  void runge_kutta(Scalar dt);
  void euler(Scalar dt, bool forward);
  void end_step(double dt);

  Integrator integrator_;
  Scalar damping_;
  std::vector<std::array<int, 4>> tetrahedra_;
  std::vector<std::array<bool, 3>> fixed_;
  std::vector<char> alive_;
  std::vector<int> around_begin_, around_;   // tetrahedra of each node, ascending
  std::vector<double> share_;                // [kg] rho V / 4 per tetrahedron
  std::vector<double> element_bound_;        // [rad^2/s^2]
  std::vector<double> mass_, coupled_mass_;  // [kg] per node
  std::vector<Eigen::Vector3d> load_;        // [N] per node
  std::vector<Eigen::Vector3d> dead_;        // [N] per node, the mesh's own
  Eigen::Vector3d gravity_ = Eigen::Vector3d::Zero();
  Array state_;     // u of all nodes, then v
  Array constant_;  // load and weight
  Array inverse_mass_, force_;
  Array stage_u_, stage_v_, sum_u_, sum_v_;
  mutable Array present_;  // elastic force at u()
  mutable bool is_present_ = false;

  Coupling* coupling_ = nullptr;
  std::vector<int> coupled_nodes_;
  double coupling_bound_ = 0;
  std::vector<double> coupled_u_, coupled_force_;
};

extern template class Staged<float>;
extern template class Staged<double>;

}  // namespace palpate
