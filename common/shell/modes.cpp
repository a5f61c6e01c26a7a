#include "common/shell/modes.hpp"

#include <Spectra/SymEigsSolver.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "common/fem/factorisation.hpp"
#include "common/geometry/dense_solvers.hpp"

namespace palpate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kGuard = 6;             // modes beyond the wanted ones: the last wanted ones converge faster
constexpr double kTolerance = 1e-11;  // of Lanczos
constexpr double kSameMode = 1e-9;    // relative difference of eigenvalues that counts as none
constexpr double kSingular = 1e-13;   // lowest omega^2 against the largest K_ii / m_i
constexpr double kNearlyLargest = 1e-6;

SparseMatrix shifted(const SparseMatrix& stiffness, const VectorXd& mass, double shift) {
  SparseMatrix sum = stiffness;
  if (shift > 0)
    for (Index i = 0; i < mass.size(); ++i) sum.coeffRef(i, i) += shift * mass[i];
  sum.makeCompressed();
  return sum;
}

/// A = M^1/2 (K + shift M)^-1 M^1/2 over the translations. Its largest eigenvalues are 1 / (omega^2 + shift)
/// of the lowest modes, its eigenvectors M^1/2 phi. The whole K is solved without moments, which condenses
/// the rotations.
class InverseOperator {
 public:
  InverseOperator(const SparseMatrix& shifted_stiffness, const VectorXd& mass)
      : root_mass_(mass.cwiseSqrt()), size_(shifted_stiffness.rows()), factor_(shifted_stiffness) {
    factor_.factorise(shifted_stiffness);
  }

  Index rows() const { return root_mass_.size(); }

  MatrixXd times(const MatrixXd& x) const {
    MatrixXd load = MatrixXd::Zero(size_, x.cols());
    load.topRows(rows()) = root_mass_.asDiagonal() * x;
    return root_mass_.asDiagonal() * factor_.solve(load).topRows(rows());
  }

 private:
  VectorXd root_mass_;
  Index size_;
  Factorisation factor_;
};

/// The operator on the complement of the columns of `known`, which are orthonormal; of all of it where there are none.
class DeflatedOperator {
 public:
  using Scalar = double;  // asked for by Spectra

  DeflatedOperator(const InverseOperator& whole, const MatrixXd& known) : whole_(whole), known_(known) {}
  Index rows() const { return whole_.rows(); }
  Index cols() const { return whole_.rows(); }

  VectorXd outside(VectorXd x) const {
    for (int pass = 0; pass < 2; ++pass) x -= known_ * (known_.transpose() * x);
    return x;
  }
  void perform_op(const double* in, double* out) const {
    Eigen::Map<VectorXd>(out, rows()) = outside(whole_.times(outside(Eigen::Map<const VectorXd>(in, rows()))));
  }

 private:
  const InverseOperator& whole_;
  const MatrixXd& known_;
};

struct Eigenpairs {
  VectorXd value;  // descending
  MatrixXd vector;
};

VectorXd start_vector(Index size) {
  std::mt19937_64 random(20010531);
  VectorXd start(size);
  for (double& x : start) x = static_cast<double>(random() >> 11) * 0x1p-52 - 1;
  return start;
}

Eigenpairs lanczos(DeflatedOperator& op, const VectorXd& start, Index count, double tolerance) {
  const Index basis = std::min(op.rows(), std::max<Index>(2 * count, count + 24));
  Spectra::SymEigsSolver<DeflatedOperator> solver(op, count, basis);
  solver.init(start.data());
  solver.compute(Spectra::SortRule::LargestAlge, 1000, tolerance, Spectra::SortRule::LargestAlge);
  if (solver.info() != Spectra::CompInfo::Successful)
    throw std::runtime_error(fmt::format("the {} lowest modes did not converge", count));
  return {solver.eigenvalues(), solver.eigenvectors()};
}

/// Rayleigh-Ritz on the span of A V: a step of subspace iteration, which also restores orthonormality.
Eigenpairs refined(const InverseOperator& op, const MatrixXd& vectors) {
  const MatrixXd basis = orthonormal_basis(op.times(vectors));
  const MatrixXd projected = basis.transpose() * op.times(basis);
  const SymmetricEigen pairs = symmetric_eigen(0.5 * (projected + projected.transpose()));
  return {pairs.value.reverse(), basis * pairs.vector.rowwise().reverse()};
}

void shorten(Eigenpairs& pairs, Index count) {
  pairs.value.conservativeResize(count);
  pairs.vector.conservativeResize(Eigen::NoChange, count);
}

/// True, and the pair added, if the complement of the pairs holds an eigenvalue above the last of them.
bool add_missed(InverseOperator& op, const VectorXd& start, Eigenpairs& pairs) {
  DeflatedOperator rest(op, pairs.vector);
  const auto top = lanczos(rest, rest.outside(start), 1, 1e-8);
  const double last = pairs.value[pairs.value.size() - 1];
  if (top.value[0] <= last * (1 + kSameMode)) return false;
  MatrixXd more(pairs.vector.rows(), pairs.vector.cols() + 1);
  more << pairs.vector, top.vector;
  pairs = refined(op, more);
  return true;
}

Eigenpairs max_pairs(InverseOperator& op, Index count) {
  const VectorXd start = start_vector(op.rows());
  const Index enough = count + kGuard;
  const MatrixXd none(op.rows(), 0);
  DeflatedOperator whole(op, none);
  auto pairs = refined(op, lanczos(whole, start, enough, kTolerance).vector);
  while (add_missed(op, start, pairs)) shorten(pairs, enough);
  shorten(pairs, count);
  return pairs;
}

/// All of them, by the dense matrix.
Eigenpairs all_pairs(const InverseOperator& op) {
  constexpr Index kBlock = 64;
  MatrixXd dense(op.rows(), op.rows());
  for (Index begin = 0; begin < op.rows(); begin += kBlock) {
    const Index count = std::min(kBlock, op.rows() - begin);
    MatrixXd unit = MatrixXd::Zero(op.rows(), count);
    for (Index c = 0; c < count; ++c) unit(begin + c, c) = 1;
    dense.middleCols(begin, count) = op.times(unit);
  }
  const SymmetricEigen pairs = symmetric_eigen(0.5 * (dense + dense.transpose()));
  return {pairs.value.reverse(), pairs.vector.rowwise().reverse()};
}

/// Largest K_ii / m_i [1/s^2]: the size of the highest omega^2.
double max_square(const SparseMatrix& stiffness, const VectorXd& mass) {
  double highest = 0;
  for (Index i = 0; i < mass.size(); ++i) highest = std::max(highest, stiffness.coeff(i, i) / mass[i]);
  return highest;
}

void choose_signs(MatrixXd& shape) {
  for (auto mode : shape.colwise()) {
    const double enough = (1 - kNearlyLargest) * mode.cwiseAbs().maxCoeff();
    const auto* first =
        std::find_if(mode.data(), mode.data() + mode.size(), [&](double x) { return std::abs(x) >= enough; });
    if (*first < 0) mode = -mode;
  }
}

}  // namespace

Modes lowest_modes(const SparseMatrix& stiffness, const VectorXd& mass, int count, double shift) {
  const Index n = mass.size();
  if (count < 1 || count > n)
    throw std::runtime_error(
        fmt::format("{} modes are asked for, but there are {} free translational degrees of freedom", count, n));
  if (!(mass.minCoeff() > 0)) throw std::runtime_error("a node without mass has no modes of vibration");
  InverseOperator op(shifted(stiffness, mass, shift), mass);
  auto pairs = 3 * (count + kGuard) < n ? max_pairs(op, count) : all_pairs(op);
  shorten(pairs, count);
  const VectorXd square = pairs.value.cwiseInverse().array() - shift;
  if (shift == 0 && !(square[0] > kSingular * max_square(stiffness, mass)))
    throw std::runtime_error("the stiffness matrix is singular: part of the body is not held");
  Modes modes{square.cwiseMax(0).cwiseSqrt(), mass.cwiseSqrt().cwiseInverse().asDiagonal() * pairs.vector};
  choose_signs(modes.shape);
  return modes;
}

}  // namespace palpate
