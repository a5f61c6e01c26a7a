#pragma once
#include "common/fem/direct.hpp"
#include "common/fem/sphere.hpp"

namespace palpate {

/// Linear elasticity under a ball that is pressed into its surface, on a mesh of any fineness: nodes that
/// would be inside the ball lie on it, are pushed along the ball's own normal and never pulled. One
/// factorisation; the contact is solved on the dense compliance among the surface nodes that the ball may
/// reach.
class LinearContact {
 public:
  /// Nodes of the surface within `reach` [m] of `centre` may touch the ball.
  LinearContact(StaticProblem problem, const Eigen::Vector3d& centre, double reach);

  /// Throws std::runtime_error if the contact does not settle or the ball comes to nodes beyond the reach.
  PressState press(const Sphere& ball) const;
  const StaticProblem& problem() const { return problem_; }
  int candidates() const { return static_cast<int>(node_.size()); }

 private:
  Eigen::VectorXd solve_normal_forces(const Sphere& ball, const std::vector<Eigen::Vector3d>& normal,
                                      std::vector<char>& active) const;

  StaticProblem problem_;
  Factorisation factor_;
  std::vector<int> surface_, node_;  // nodes of the surface; candidates among them
  Eigen::MatrixXd compliance_;       // [m/N] 3 entries a candidate; fixed axes hold zeros
};

}  // namespace palpate
