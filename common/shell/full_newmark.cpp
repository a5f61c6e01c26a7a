#include "common/shell/full_newmark.hpp"

#include <memory>
#include <stdexcept>

#include "common/fem/factorisation.hpp"
#include "common/geometry/dense_solvers.hpp"

namespace palpate {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Map = std::function<VectorXd(const VectorXd&)>;

/// a0 of BHS01 app. B c: K^ = K + a0 M [1/s^2].
double mass_share(double damping, double step) {
  return (4 + 2 * damping * step) / (step * step);
}

Map sparse_solver(SparseMatrix lower, const VectorXd& mass, double share) {
  for (Eigen::Index i = 0; i < mass.size(); ++i) lower.coeffRef(i, i) += share * mass[i];
  lower.makeCompressed();
  const auto factor = std::make_shared<Factorisation>(lower);
  factor->factorise(lower);
  return [factor, size = lower.rows()](const VectorXd& f) -> VectorXd {
    VectorXd load = VectorXd::Zero(size);
    load.head(f.size()) = f;
    return factor->solve(load).topRows(f.size());
  };
}

/// u -> K_tt u - K_tr K_rr^-1 K_rt u.
Map sparse_product(const SparseMatrix& lower, Eigen::Index translations) {
  const Eigen::Index rotations = lower.rows() - translations;
  const SparseMatrix tt = lower.topLeftCorner(translations, translations);
  const SparseMatrix rt = lower.bottomLeftCorner(rotations, translations);
  if (rotations == 0) return [tt](const VectorXd& u) -> VectorXd { return tt.selfadjointView<Eigen::Lower>() * u; };
  const SparseMatrix rr = lower.bottomRightCorner(rotations, rotations);
  const auto factor = std::make_shared<Factorisation>(rr);
  factor->factorise(rr);
  return [tt, rt, factor](const VectorXd& u) -> VectorXd {
    const VectorXd moments = rt * u;
    return tt.selfadjointView<Eigen::Lower>() * u - rt.transpose() * VectorXd(factor->solve(moments));
  };
}

}  // namespace

FullNewmark::FullNewmark(const SparseMatrix& stiffness, VectorXd mass, double damping, double step)
    : mass_(std::move(mass)),
      damping_(damping),
      step_(step),
      stiffness_times_(sparse_product(stiffness, mass_.size())),
      solve_(sparse_solver(stiffness, mass_, mass_share(damping, step))) {}

FullNewmark::FullNewmark(const MatrixXd& condensed, VectorXd mass, double damping, double step)
    : mass_(std::move(mass)), damping_(damping), step_(step) {
  MatrixXd modified = condensed;
  modified.diagonal() += mass_share(damping, step) * mass_;
  const auto factor = std::make_shared<DenseCholesky>(modified);
  if (!factor->positive_definite()) throw std::runtime_error("the stiffness matrix is not positive definite");
  stiffness_times_ = [condensed](const VectorXd& u) -> VectorXd { return condensed * u; };
  solve_ = [factor](const VectorXd& f) -> VectorXd { return factor->solve(f); };
}

void FullNewmark::start(const VectorXd& u, const VectorXd& v, const VectorXd& f) {
  u_ = u;
  v_ = v;
  a_ = (f - stiffness_times_(u)).cwiseQuotient(mass_) - damping_ * v;
}

void FullNewmark::step(const VectorXd& f) {
  const double h = step_;
  const VectorXd inertia = mass_share(damping_, h) * u_ + (4 / h + damping_) * v_ + a_;
  const VectorXd u = solve_(f + mass_.cwiseProduct(inertia));
  const VectorXd a = 4 / (h * h) * (u - u_ - h * v_) - a_;
  v_ += h / 2 * (a_ + a);
  u_ = u;
  a_ = a;
}

CentralDifference::CentralDifference(MatrixXd condensed, VectorXd mass, double damping, double step)
    : stiffness_(std::move(condensed)), mass_(std::move(mass)), damping_(damping), step_(step) {}

void CentralDifference::start(const VectorXd& u, const VectorXd& v, const VectorXd& f) {
  const VectorXd a = (f - stiffness_ * u).cwiseQuotient(mass_) - damping_ * v;
  u_ = u;
  before_ = u - step_ * v + step_ * step_ / 2 * a;
}

void CentralDifference::step(const VectorXd& f) {
  const double h = step_, drag = damping_ * h / 2;
  const VectorXd push = h * h * (f - stiffness_ * u_).cwiseQuotient(mass_);
  const VectorXd next = (push + 2 * u_ - (1 - drag) * before_) / (1 + drag);
  before_ = u_;
  u_ = next;
}

}  // namespace palpate
