#pragma once
#include "common/dynamics/linear_tissue.hpp"

namespace palpate {

/// Tensor-mass tissue (RR3510 sec. 5): one 3x3 tensor per edge and vertex. Force on node i: -sum K_ij (u_j - u_i),
/// which is eq. 6, for the vertex tensor K_ii is minus the sum of the node's edge tensors; so a rigid translation gives
/// exactly no force, in single precision too.
template <class Scalar>
class TensorMass final : public LinearTissue<Scalar> {
 public:
  /// `damping` [1/s] >= 0. Throws std::runtime_error as ElementTensors does.
  TensorMass(const ElasticMesh& mesh, Integrator integrator, double damping);

  using LinearTissue<Scalar>::displacement;
  Eigen::Vector3d elastic_force(int node) const override;

  /// The tensors in use [N/m], as stored. An edge that does not exist has zero.
  Eigen::Matrix3d edge_tensor(int i, int j) const;
  Eigen::Matrix3d vertex_tensor(int i) const;

 protected:
  using Arrays = kernels::NodeArrays<Scalar>;
  void rk4_first(const Arrays& arrays, double damping) override;
  void rk4_second(const Arrays& arrays, double damping, double dt) override;
  void semi_implicit(const Arrays& arrays, double damping, double dt) override;
  void forward_euler(const Arrays& arrays, double damping, double dt) override;
  void rewrite(int tetrahedron) override;
  double elastic_energy() const override;
  double frequency_squared() const override { return elements().frequency_squared(); }

 private:
  using LinearTissue<Scalar>::elements;
  using LinearTissue<Scalar>::row;

  ElementTensors::Corners displacements(int t) const;
  void lay_out_edges();
  void write_edge(int edge);

  std::vector<int> begin_, column_;  // as in EdgeBlocks
  std::vector<int> slot_;            // of each edge in block_
  std::vector<Scalar, kernels::LineAllocator<Scalar>> block_;
  kernels::EdgeBlocks<Scalar> blocks_;
};

extern template class TensorMass<float>;
extern template class TensorMass<double>;

}  // namespace palpate
