#pragma once
#include <Eigen/Core>

namespace palpate {

/// Dense algebra by BLAS and LAPACK on column-major matrices. A "lower" argument is read below its diagonal
/// alone.
using DenseRef = Eigen::Ref<Eigen::MatrixXd>;
using ConstDenseRef = Eigen::Ref<const Eigen::MatrixXd>;

/// In place: the lower triangle of a Cholesky factor L becomes the lower triangle of (L L^T)^-1.
/// Throws std::runtime_error if L is singular.
void invert_from_cholesky(DenseRef factor);

/// out = factor * S B, S symmetric with its lower triangle given.
void multiply_symmetric(double factor, const ConstDenseRef& symmetric_lower, const ConstDenseRef& b, DenseRef out);

/// In place: B becomes B L^-1.
void divide_by_lower(DenseRef b, const ConstDenseRef& lower);

/// A B: the yardstick of the benchmarks.
Eigen::MatrixXd dense_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Packs a lower triangle by rows: entry (i,j), j <= i, to i(i+1)/2 + j.
void pack_lower_by_rows(const ConstDenseRef& lower, double* packed);

/// Largest number of threads that the functions here and the factorisation use.
void set_linear_algebra_threads(int threads);

/// While it lives, linear algebra takes one thread: for work that is shared among threads in larger pieces.
class OneLinearAlgebraThread {
 public:
  OneLinearAlgebraThread();
  ~OneLinearAlgebraThread();
  OneLinearAlgebraThread(const OneLinearAlgebraThread&) = delete;
  OneLinearAlgebraThread& operator=(const OneLinearAlgebraThread&) = delete;

 private:
  int before_;
};

}  // namespace palpate
