#pragma once
#include "common/dynamics/staged.hpp"

namespace palpate {

/// Point masses joined by springs along the edges of the mesh (RR3510 eq. 7).
///
/// Stiffness after Van Gelder 1998, Approximate simulation of elastic membranes by triangulated spring
/// meshes, J. Graphics Tools 3(2): k = E sum V / l^2 over the tetrahedra around the edge. A network of
/// springs that points equally into all directions then has Young's modulus E and Poisson's ratio 1/4, the
/// one value that springs can have: the body's own is not used. Meshes whose edges follow the axes of a grid
/// are stiffer along those axes; see docs/models.md.
///
/// The bound: the Hessian of a spring is at most k I at any stretch and direction, so that an edge weighs k
/// |u_i - u_j|^2 and each tetrahedron with its share of the stiffnesses and masses bounds the whole, as
/// finite elements do. The bound only falls when tetrahedra go.
template <class Scalar>
class SpringMass final : public Staged<Scalar> {
 public:
  /// `damping` [1/s] >= 0. Throws std::runtime_error as Staged does.
  SpringMass(const ElasticMesh& mesh, Integrator integrator, double damping);

  /// Springs of the mesh as it was built; those of removed tetrahedra alone have stiffness 0.
  int springs() const { return static_cast<int>(rest_.size()); }
  double stiffness(int spring) const { return stiffness_[spring]; }  ///< [N/m]
  const std::array<int, 2>& ends(int spring) const { return ends_[spring]; }

 protected:
  void add_forces(const Scalar* u, Scalar* force) const override;
  double elastic_energy() const override;
  void take_out(int tetrahedron) override;

 private:
  void list_tetrahedra();
  void set_bounds(const ElasticMesh& mesh);
  void sum_stiffness(int spring);

  std::vector<std::array<int, 2>> ends_;        // ascending
  std::vector<Eigen::Vector3d> rest_;           // [m] from the first end to the second
  std::vector<double> stiffness_;               // [N/m]
  std::vector<int> around_begin_, around_;      // tetrahedra of each spring, ascending
  std::vector<std::array<int, 6>> springs_of_;  // per tetrahedron
  std::vector<double> young_volume_;            // [J] E V per tetrahedron
  std::vector<kernels::SpringQuad<Scalar>, kernels::LineAllocator<kernels::SpringQuad<Scalar>>> quads_;
};

extern template class SpringMass<float>;
extern template class SpringMass<double>;

}  // namespace palpate
