#pragma once
#include <span>

#include "common/fem/direct.hpp"
#include "common/fem/sphere.hpp"

namespace palpate {

/// Linear elasticity under a ball that is pressed into its surface, on a mesh of any fineness: nodes that
/// would be inside the ball lie on it, are pushed along the ball's own normal and never pulled. One
/// factorisation; the contact is solved on the dense compliance among the surface nodes that the ball may
/// reach.
class LinearContact {
 public:
  /// Nodes of the surface within `reach` [m] of one of `centres` may touch the ball.
  LinearContact(StaticProblem problem, std::span<const Eigen::Vector3d> centres, double reach);

  /// Throws std::runtime_error if the contact does not settle or the ball comes to nodes beyond the reach.
  PressState press(const Sphere& ball) const;
  const StaticProblem& problem() const { return problem_; }
  int candidates() const { return static_cast<int>(all_.node.size()); }

 private:
  /// Nodes that may touch the ball.
  struct Candidates {
    std::vector<int> node;
    Eigen::MatrixXd compliance;  // [m/N] among them, 3 entries a node; fixed axes hold zeros
  };
  Candidates near(const Sphere& ball) const;
  Eigen::VectorXd solve_normal_forces(const Sphere& ball, const Candidates& candidates,
                                      const std::vector<Eigen::Vector3d>& normal, std::vector<char>& active) const;

  StaticProblem problem_;
  std::vector<int> surface_;  // nodes of the surface
  Candidates all_;
  Factorisation factor_;
};

}  // namespace palpate
