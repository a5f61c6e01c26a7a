#include "common/fem/dense.hpp"

#include <cblas.h>

#include <algorithm>
#include <stdexcept>

extern "C" void dpotri_(const char* uplo, const int* n, double* a, const int* lda, int* info);

namespace palpate {
namespace {

int rows(const ConstDenseRef& m) {
  return static_cast<int>(m.rows());
}
int columns(const ConstDenseRef& m) {
  return static_cast<int>(m.cols());
}
int stride(const ConstDenseRef& m) {
  return static_cast<int>(m.outerStride());
}

}  // namespace

void invert_from_cholesky(DenseRef factor) {
  keep_to_calling_thread();
  const int n = rows(factor), leading = stride(factor);
  int info = 0;
  dpotri_("L", &n, factor.data(), &leading, &info);
  if (info != 0) throw std::runtime_error("the compliance of the surface is singular");
}

void multiply_symmetric(double factor, const ConstDenseRef& symmetric_lower, const ConstDenseRef& b, DenseRef out) {
  keep_to_calling_thread();
  cblas_dsymm(CblasColMajor, CblasLeft, CblasLower, rows(out), columns(out), factor, symmetric_lower.data(),
              stride(symmetric_lower), b.data(), stride(b), 0.0, out.data(), stride(out));
}

void divide_by_lower(DenseRef b, const ConstDenseRef& lower) {
  keep_to_calling_thread();
  cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasNoTrans, CblasNonUnit, rows(b), columns(b), 1.0, lower.data(),
              stride(lower), b.data(), stride(b));
}

Eigen::MatrixXd dense_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  keep_to_calling_thread();
  Eigen::MatrixXd product(a.rows(), b.cols());
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, rows(a), columns(b), columns(a), 1.0, a.data(), stride(a),
              b.data(), stride(b), 0.0, product.data(), stride(product));
  return product;
}

void pack_lower_by_rows(const ConstDenseRef& lower, double* packed) {
  constexpr Eigen::Index kBlock = 32;
  const Eigen::Index n = lower.rows();
  for (Eigen::Index row = 0; row < n; row += kBlock)
    for (Eigen::Index column = 0; column <= row; column += kBlock)
      for (Eigen::Index i = row; i < std::min(row + kBlock, n); ++i)
        for (Eigen::Index j = column; j <= std::min(column + kBlock - 1, i); ++j)
          packed[i * (i + 1) / 2 + j] = lower(i, j);
}

void keep_to_calling_thread() {
  openblas_set_num_threads(1);
}

std::string blas_kernels() {
  return openblas_get_corename();
}

}  // namespace palpate
