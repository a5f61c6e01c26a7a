#pragma once
#include "common/dynamics/dynamic_model.hpp"
#include "common/dynamics/element_tensors.hpp"
#include "common/kernels/kernels.hpp"

namespace palpate {

/// Tensor-mass tissue (RR3510 sec. 5): one 3x3 tensor per edge and vertex, lumped masses rho V/4, damping
/// proportional to mass. Force on node i: -sum K_ij (u_j - u_i), which is eq. 6, for the vertex tensor K_ii
/// is minus the sum of the node's edge tensors; so a rigid translation gives exactly no force, in single
/// precision too. Displacement conditions: fixed axes have no inverse mass; other prescribed motion is set
/// between steps.
template <class Scalar>
class TensorMass final : public DynamicModel {
 public:
  /// `damping` [1/s] >= 0. Throws std::runtime_error as ElementTensors does.
  TensorMass(const ElasticMesh& mesh, Integrator integrator, double damping);
  TensorMass(const TensorMass&) = delete;
  TensorMass& operator=(const TensorMass&) = delete;

  /// [m/s^2]; acts on the tetrahedra's own mass beside the loads, and follows that mass through removals.
  void set_gravity(const Eigen::Vector3d& gravity);

  double frequency_bound() const override;
  void step(double dt) override { step(dt, integrator_); }
  void step_semi_implicit(double dt) override { step(dt, Integrator::semi_implicit); }
  void remove(std::span<const int> tetrahedra) override;
  void couple(Coupling* coupling, std::span<const int> nodes, std::span<const double> mass, double bound) override;

  Eigen::Vector3d displacement(int node) const override { return vector_at(node, 0); }
  Eigen::Vector3d velocity(int node) const override { return vector_at(node, 4); }
  void set_motion(int node, const Eigen::Vector3d& u, const Eigen::Vector3d& v) override;
  double mass(int node) const override;
  void set_load(int node, const Eigen::Vector3d& force) override;
  Eigen::Vector3d load(int node) const override { return load_[node]; }
  Eigen::Vector3d elastic_force(int node) const override;
  double energy() const override;
  int nodes() const override { return static_cast<int>(row_.size()); }

  void state(State& s) override { s.all(motion_); }

  /// The tensors in use [N/m], as stored. An edge that does not exist has zero.
  Eigen::Matrix3d edge_tensor(int i, int j) const;
  Eigen::Matrix3d vertex_tensor(int i) const;

 private:
  template <class T>
  using Array = std::vector<T, kernels::LineAllocator<T>>;

  Eigen::Vector3d vector_at(int node, int first) const;
  ElementTensors::Corners displacements(int t) const;
  void lay_out_edges();
  void write_edge(int edge);
  void write_response(int node);
  void step(double dt, Integrator integrator);
  void couple_pass(const Scalar* pair, int vectors);

  ElementTensors elements_;
  Integrator integrator_;
  double damping_;
  const kernels::Table& kernels_;
  std::vector<std::array<bool, 3>> fixed_;
  Eigen::Vector3d gravity_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> load_;          // per node
  std::vector<double> own_mass_, added_mass_;  // per node

  std::vector<int> row_;             // of each node in the arrays below
  std::vector<int> begin_, column_;  // as in EdgeBlocks
  std::vector<int> slot_;            // of each edge in block_
  Array<Scalar> block_;
  Array<Scalar> motion_, rates_, product_, response_;  // as in NodeArrays
  kernels::EdgeBlocks<Scalar> blocks_;
  kernels::NodeArrays<Scalar> arrays_;

  Coupling* coupling_ = nullptr;
  double coupling_bound_ = 0;
  std::vector<int> coupled_;  // nodes
  std::vector<double> coupled_vector_, coupled_force_;
};

extern template class TensorMass<float>;
extern template class TensorMass<double>;

}  // namespace palpate
