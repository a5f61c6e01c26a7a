#pragma once
#include "common/dynamics/dynamic_model.hpp"
#include "common/dynamics/element_tensors.hpp"
#include "common/kernels/kernels.hpp"

namespace palpate {

/// Tissue whose elastic force is linear in the displacements, with lumped masses rho V/4 and damping proportional to
/// mass. Its step is the Taylor polynomial of the motion, whose products with the stiffness pair up: two passes a step
/// of RK4. Displacement conditions: fixed axes have no inverse mass; other prescribed motion is set between steps.
/// Models say what multiplies with the stiffness.
template <class Scalar>
class LinearTissue : public DynamicModel {
 public:
  LinearTissue(const LinearTissue&) = delete;
  LinearTissue& operator=(const LinearTissue&) = delete;

  /// [m/s^2]; acts on the tetrahedra's own mass beside the loads, and follows that mass through removals.
  void set_gravity(const Eigen::Vector3d& gravity);

  double frequency_bound() const final;
  void step(double dt) final { step(dt, integrator_); }
  void step_semi_implicit(double dt) final { step(dt, Integrator::semi_implicit); }
  void remove(std::span<const int> tetrahedra) final;
  void couple(Coupling* coupling, std::span<const int> nodes, std::span<const double> mass, double bound) final;

  Eigen::Vector3d displacement(int node) const final { return vector_at(node, 0); }
  Eigen::Vector3d velocity(int node) const final { return vector_at(node, 4); }
  void set_motion(int node, const Eigen::Vector3d& u, const Eigen::Vector3d& v) final;
  double mass(int node) const final { return own_mass_[node] + added_mass_[node]; }
  void set_load(int node, const Eigen::Vector3d& force) final;
  Eigen::Vector3d load(int node) const final { return load_[node]; }
  double energy() const final;
  int nodes() const final { return static_cast<int>(row_.size()); }

  void state(State& s) final { s.all(motion_); }

 protected:
  template <class T>
  using Array = std::vector<T, kernels::LineAllocator<T>>;
  using Arrays = kernels::NodeArrays<Scalar>;

  /// `damping` [1/s] >= 0. Throws std::runtime_error as ElementTensors does.
  LinearTissue(const ElasticMesh& mesh, Integrator integrator, double damping);

  virtual void rk4_first(const Arrays& arrays, double damping) = 0;
  virtual void rk4_second(const Arrays& arrays, double damping, double dt) = 0;
  virtual void semi_implicit(const Arrays& arrays, double damping, double dt) = 0;
  virtual void forward_euler(const Arrays& arrays, double damping, double dt) = 0;
  /// Sums anew what a tetrahedron that is out took part in.
  virtual void rewrite(int tetrahedron) = 0;
  /// [J] at the present displacements.
  virtual double elastic_energy() const = 0;
  /// [rad^2/s^2] above the square of every angular frequency, whatever is removed.
  virtual double frequency_squared() const = 0;

  /// The kernel of the scalar type in use.
  template <class F, class D>
  static auto of_type(F single, D twice) {
    if constexpr (std::is_same_v<Scalar, float>)
      return single;
    else
      return twice;
  }
  const ElementTensors& elements() const { return elements_; }
  const kernels::Table& kernels() const { return kernels_; }
  int row(int node) const { return row_[node]; }  ///< of a node in the kernels' arrays

 private:
  Eigen::Vector3d vector_at(int node, int first) const;
  void write_response(int node);
  void step(double dt, Integrator integrator);
  void couple_pass(const Scalar* pair, int vectors);

  ElementTensors elements_;
  Integrator integrator_;
  double damping_;
  const kernels::Table& kernels_;
  std::vector<std::array<bool, 3>> fixed_;
  Eigen::Vector3d gravity_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> load_;                  // per node
  std::vector<Eigen::Vector3d> dead_;                  // [N] per node, the mesh's own
  std::vector<double> own_mass_, added_mass_;          // per node
  std::vector<int> row_;                               // of each node in the arrays below
  Array<Scalar> motion_, rates_, product_, response_;  // as in NodeArrays
  Arrays arrays_;

  Coupling* coupling_ = nullptr;
  double coupling_bound_ = 0;
  std::vector<int> coupled_;  // nodes
  std::vector<double> coupled_vector_, coupled_force_;
};

extern template class LinearTissue<float>;
extern template class LinearTissue<double>;

}  // namespace palpate
