#pragma once
#include "common/dynamics/linear_tissue.hpp"
#include "common/fem/nodal_patches.hpp"

namespace palpate {

/// Tissue of linear tetrahedra whose strain is averaged at their nodes, stabilised: it does not lock near
/// incompressibility and bends as it should on coarse meshes; see NodalPatches. A product with its stiffness takes the
/// patches' stresses first, by the ties of each patch's own node, and then each node's force from the patches that it
/// belongs to. A removal sums the patches of its four corners anew.
template <class Scalar>
class NodalStrain final : public LinearTissue<Scalar> {
 public:
  /// `damping` [1/s] >= 0. Throws std::runtime_error as ElementTensors does.
  NodalStrain(const ElasticMesh& mesh, Integrator integrator, double damping);

  using LinearTissue<Scalar>::displacement;
  Eigen::Vector3d elastic_force(int node) const override;

 protected:
  using Arrays = kernels::NodeArrays<Scalar>;
  void rk4_first(const Arrays& arrays, double damping) override;
  void rk4_second(const Arrays& arrays, double damping, double dt) override;
  void semi_implicit(const Arrays& arrays, double damping, double dt) override;
  void forward_euler(const Arrays& arrays, double damping, double dt) override;
  void rewrite(int tetrahedron) override;
  double elastic_energy() const override;
  double frequency_squared() const override { return frequency_squared_; }

 private:
  template <class T>
  using Array = std::vector<T, kernels::LineAllocator<T>>;
  using LinearTissue<Scalar>::row;

  void bound_frequencies(const ElasticMesh& mesh);
  void lay_out_ties();
  void lay_out_shares();
  void write_patch(int patch);
  template <class Take>
  void exert(int patch, Take&& take) const;

  NodalPatches patches_;
  std::vector<char> alive_;
  double frequency_squared_ = 0;
  std::vector<NodalPatches::Tie> ties_;  // of one patch: scratch
  std::vector<int> place_, patch_at_;    // of each patch in the kernels' order, and back
  std::vector<double> volume_;           // [m^3] per patch; 0 where nothing is left
  Incidence around_;                     // patches that each node belongs to

  std::vector<std::vector<int>> share_of_;  // of each patch and each node in its list: its place in share_

  std::vector<int> node_, begin_, column_, first_, member_;  // as in PatchRows
  Array<Scalar> tie_, patch_, share_, stress_;
  kernels::PatchRows<Scalar> rows_;
};

extern template class NodalStrain<float>;
extern template class NodalStrain<double>;

}  // namespace palpate
