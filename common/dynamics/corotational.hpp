#pragma once
#include "common/dynamics/staged.hpp"

namespace palpate {

/// Linear elasticity in each tetrahedron's own rotated frame: large rotations cost nothing, and small
/// displacements give the forces of the linear model. With F = I + grad u and R the rotation nearest to it,
///   W = V (mu |F - R|^2 + lambda/2 tr(R^T F - I)^2),   P = dW/dF = 2 mu (F - R) + lambda tr(R^T F - I) R.
/// P is the exact derivative of W, R's own change included, because R maximises tr(R^T F). So energy is kept
/// by the equation of motion, forces sum to zero, and so do their moments. R follows from F alone: nothing is
/// remembered from step to step, and inverted or flat elements have a rotation too.
///
/// The linear element's bound holds at any rotation, and under stretch as long as lambda tr(R^T F - I) stays
/// below mu (s_i + s_j) for the singular values of F: dilations of some 20 % at nu = 0.45. Beyond it the
/// tension across an element exceeds its own stiffness.
template <class Scalar>
class Corotational final : public Staged<Scalar> {
 public:
  /// `damping` [1/s] >= 0. Throws std::runtime_error as Staged does.
  Corotational(const ElasticMesh& mesh, Integrator integrator, double damping);

 protected:
  void add_forces(const Scalar* u, Scalar* force) const override;
  double elastic_energy() const override;
  void take_out(int tetrahedron) override;

 private:
  std::vector<kernels::TetQuad<Scalar>, kernels::LineAllocator<kernels::TetQuad<Scalar>>> quads_;
};

extern template class Corotational<float>;
extern template class Corotational<double>;

}  // namespace palpate
