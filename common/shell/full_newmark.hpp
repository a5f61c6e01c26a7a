#pragma once
#include <Eigen/Core>
#include <functional>

#include "common/fem/assembly.hpp"

namespace palpate {

/// Newmark's integration of the unreduced system M a + damping M v + K u = f over the free translations,
/// rotations massless and without moments (BHS01 app. B "DNIOS", average acceleration; K^ U^ = F^ where eq.
/// 26 prints it turned about). The reference for the modes; for offline use, each step allocates.
class FullNewmark {
 public:
  /// Sparse: the rotations stay among the unknowns. `stiffness`: lower triangle [N/m], the translations
  /// first; `mass` [kg] per translation; `damping` [1/s]; `step` [s]. Throws std::runtime_error if K is not
  /// positive definite.
  FullNewmark(const SparseMatrix& stiffness, Eigen::VectorXd mass, double damping, double step);
  /// Dense, as the paper has it: the condensed stiffness of condense_rotations() and its Cholesky factor.
  FullNewmark(const Eigen::MatrixXd& condensed, Eigen::VectorXd mass, double damping, double step);

  /// Sets u [m], v [m/s] and the acceleration that f [N] gives them.
  void start(const Eigen::VectorXd& u, const Eigen::VectorXd& v, const Eigen::VectorXd& f);
  /// One step; f [N] acts at its end.
  void step(const Eigen::VectorXd& f);

  const Eigen::VectorXd& displacement() const { return u_; }
  const Eigen::VectorXd& velocity() const { return v_; }
  const Eigen::VectorXd& acceleration() const { return a_; }
  /// M a + damping M v + K u [N], which is f again (BHS01 app. B step 4).
  Eigen::VectorXd force() const { return mass_.cwiseProduct(a_ + damping_ * v_) + stiffness_times_(u_); }
  /// Kinetic and elastic energy [J].
  double energy() const { return 0.5 * (v_.dot(mass_.cwiseProduct(v_)) + u_.dot(stiffness_times_(u_))); }

 private:
  using Map = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

  Eigen::VectorXd mass_;  // [kg]
  double damping_, step_;
  Map stiffness_times_;  // the condensed K [N/m]
  Map solve_;            // with K + a0 M
  Eigen::VectorXd u_, v_, a_;
};

/// The central-difference scheme on the condensed system, which BHS01 sec. V-C-1 i warns of: without damping
/// it is stable up to the step T/pi, T being the shortest period.
class CentralDifference {
 public:
  CentralDifference(Eigen::MatrixXd condensed, Eigen::VectorXd mass, double damping, double step);

  void start(const Eigen::VectorXd& u, const Eigen::VectorXd& v, const Eigen::VectorXd& f);
  /// One step; f [N] acts at its beginning.
  void step(const Eigen::VectorXd& f);

  const Eigen::VectorXd& displacement() const { return u_; }

 private:
  Eigen::MatrixXd stiffness_;
  Eigen::VectorXd mass_;
  double damping_, step_;
  Eigen::VectorXd u_, before_;
};

}  // namespace palpate
