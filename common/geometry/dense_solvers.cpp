#include "common/geometry/dense_solvers.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace palpate {

using Eigen::MatrixXd;
using Eigen::VectorXd;

DenseCholesky::DenseCholesky(const MatrixXd& matrix) : factor_(matrix) {}

bool DenseCholesky::positive_definite() const {
  return factor_.info() == Eigen::Success;
}

bool DenseCholesky::well_conditioned() const {
  return positive_definite() && factor_.rcond() > 1e-12;
}

VectorXd DenseCholesky::solve(const VectorXd& right) const {
  return factor_.solve(right);
}

SymmetricEigen symmetric_eigen(const MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

VectorXd symmetric_eigenvalues(const MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

VectorXd solve_semidefinite(const MatrixXd& matrix, const VectorXd& right) {
  return matrix.ldlt().solve(right);
}

MatrixXd invert_semidefinite(const MatrixXd& matrix) {
  return matrix.ldlt().solve(MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

VectorXd solve_general(const MatrixXd& matrix, const VectorXd& right) {
  return matrix.partialPivLu().solve(right);
}

MatrixXd invert_general(const MatrixXd& matrix) {
  return matrix.inverse();
}

VectorXd least_squares(const MatrixXd& a, const VectorXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

MatrixXd orthonormal_basis(const MatrixXd& columns) {
  const Eigen::HouseholderQR<MatrixXd> qr(columns);
  return qr.householderQ() * MatrixXd::Identity(columns.rows(), columns.cols());
}

}  // namespace palpate
