#pragma once
#include <optional>
#include <span>

#include "common/fem/direct.hpp"
#include "common/fem/neo_hookean.hpp"
#include "common/fem/sphere.hpp"

namespace palpate {

/// How a solve went.
struct NewtonOutcome {
  bool converged = false;
  int iterations = 0;
  int shifted = 0;      ///< factorisations that needed a positive shift
  double residual = 0;  ///< [1] size of the unbalanced force against that of all elements' forces
};

/// Equilibrium of a body at any deformation by Newton's method with backtracking line search on the energy.
/// Fixed axes may be given displacements; a rigid frictionless ball meets the surface nodes through a stiff
/// spring on one side,
///   1/2 k A (depth of the node in the ball)^2,   A: its share of the surface at rest,
/// whose remaining depth press() reports.
class NewtonSolid {
 public:
  /// `stiffness` [Pa/m] k of the contact; 0: 1000 E/R, which leaves some thousandths of R at strains of one.
  NewtonSolid(StaticProblem problem, Law law, double stiffness = 0);

  /// Displacement [m] of a fixed axis from now on.
  void prescribe(int node, int axis, double value);
  /// Goes on from the last converged state; on failure the state stays as it was.
  NewtonOutcome solve(const std::optional<Sphere>& ball);
  /// How a ball is brought nearer.
  struct Stepping {
    double stride = 0.1;    ///< of its radius, in one step of load
    int max_halvings = 12;  ///< of a step, on end
  };
  /// Solves with the ball brought from `from` (the last one) to `to` in steps, or shorter ones where those do not
  /// converge. Throws std::runtime_error if the halvings do not help.
  PressState press(const Sphere& from, const Sphere& to, const Stepping& stepping);
  PressState press(const Sphere& from, const Sphere& to) { return press(from, to, Stepping()); }

  const std::vector<Eigen::Vector3d>& displacement() const { return u_; }
  PressState state(const std::optional<Sphere>& ball) const;
  /// [N] on the tissue at every node, by supports and contact: dW/du.
  std::vector<Eigen::Vector3d> internal_force() const;
  double energy(const std::vector<Eigen::Vector3d>& u, const std::optional<Sphere>& ball) const;
  const StaticProblem& problem() const { return problem_; }
  int steps() const { return steps_; }            ///< of load, in all presses so far
  int iterations() const { return iterations_; }  ///< of Newton's method, likewise

 private:
  Eigen::Matrix<double, 4, 3> corners(std::size_t t, const std::vector<Eigen::Vector3d>& u) const;
  void find_places();
  double assemble(const std::optional<Sphere>& ball);
  void add_contact(const Sphere& ball);
  void predict(const Sphere& ball, double ratio);
  Eigen::VectorXd direction(int& shifted);
  double contact_stiffness(int s, const Sphere& ball) const;

  StaticProblem problem_;
  Law law_;
  double stiffness_;
  std::vector<TetGradients> tets_;
  std::vector<Lame> lame_;
  std::vector<int> surface_;
  std::vector<double> area_;  // [m^2] per surface node
  SparseMatrix tangent_;
  std::vector<std::int64_t> place_;  // in the tangent's values, 144 per tetrahedron; -1: none
  std::vector<std::int64_t> block_;  // 9 per surface node
  Eigen::VectorXd gradient_;
  std::optional<Factorisation> factor_;
  std::vector<Eigen::Vector3d> u_, before_;  // [m] now, and at the last step of load but one
  double last_way_ = 0;                      // [m] of the ball in the last step of load
  int steps_ = 0, iterations_ = 0;
};

}  // namespace palpate
