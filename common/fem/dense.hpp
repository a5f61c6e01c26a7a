#pragma once
#include <Eigen/Core>
#include <string>

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

/// From now on OpenBLAS computes in the thread that calls it: how it shares work among threads changes the last bits,
/// and an archive must not depend on how many cores its host has. The functions here and CholmodContext call it.
void keep_to_calling_thread();

/// For which processor OpenBLAS computes here, on whose kernels the last bits of all tensors hang too.
std::string blas_kernels();

}  // namespace palpate
