#pragma once
#include <cholmod.h>
#include <omp.h>

#include <span>
#include <stdexcept>

#include "common/fem/assembly.hpp"
#include "common/fem/dense.hpp"

namespace palpate {

/// A started CHOLMOD workspace with 64-bit indices, used by the thread that makes it, in which its linear algebra runs.
/// Private to common/fem.
class CholmodContext {
 public:
  CholmodContext() {
    keep_to_calling_thread();
    cholmod_l_start(&common_);
    common_.print = 0;
    // CHOLMOD copies small blocks in four threads, however many cores there are: they wait longer than they copy.
    omp_set_max_active_levels(0);
  }
  ~CholmodContext() { cholmod_l_finish(&common_); }
  CholmodContext(const CholmodContext&) = delete;
  CholmodContext& operator=(const CholmodContext&) = delete;

  cholmod_common* get() { return &common_; }
  cholmod_common* operator->() { return &common_; }

 private:
  cholmod_common common_;
};

/// A view of a lower triangle as CHOLMOD sees it; copies nothing.
inline cholmod_sparse cholmod_view(const SparseMatrix& lower) {
  cholmod_sparse view{};
  view.nrow = lower.rows();
  view.ncol = lower.cols();
  view.nzmax = lower.nonZeros();
  view.p = const_cast<std::int64_t*>(lower.outerIndexPtr());
  view.i = const_cast<std::int64_t*>(lower.innerIndexPtr());
  view.x = const_cast<double*>(lower.valuePtr());
  view.stype = -1;
  view.itype = CHOLMOD_LONG;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

/// A view of a dense matrix, by columns; copies nothing.
inline cholmod_dense cholmod_view(const Eigen::MatrixXd& matrix) {
  cholmod_dense view{};
  view.nrow = view.d = matrix.rows();
  view.ncol = matrix.cols();
  view.nzmax = matrix.size();
  view.x = const_cast<double*>(matrix.data());
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

}  // namespace palpate
