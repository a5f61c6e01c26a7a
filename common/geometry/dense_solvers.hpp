#pragma once
#include <Eigen/Cholesky>

namespace palpate {

/// Eigen's decompositions of dense matrices. They are compiled here alone: each costs seconds wherever it is used.

/// L L^T of a symmetric matrix, of which the lower half is read.
class DenseCholesky {
 public:
  explicit DenseCholesky(const Eigen::MatrixXd& matrix);
  bool positive_definite() const;
  /// Positive definite, and the reciprocal of its condition number is above 1e-12.
  bool well_conditioned() const;
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;

 private:
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

struct SymmetricEigen {
  Eigen::VectorXd value;   ///< ascending
  Eigen::MatrixXd vector;  ///< a column each, of length 1
};
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);  ///< ascending

/// By L D L^T with pivots, for matrices that may be nearly singular.
Eigen::VectorXd solve_semidefinite(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
Eigen::MatrixXd invert_semidefinite(const Eigen::MatrixXd& matrix);

/// Of a square matrix that need not be symmetric.
Eigen::VectorXd solve_general(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
Eigen::MatrixXd invert_general(const Eigen::MatrixXd& matrix);

/// The x that minimises |A x - b|, by Householder reflections with pivots. A has at least as many rows as columns.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// An orthonormal basis of the span of the columns, as many as there are.
Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& columns);

}  // namespace palpate
