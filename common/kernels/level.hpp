#pragma once
#include <cstddef>

#include "common/kernels/block_rows.hpp"
#include "common/kernels/patch_rows.hpp"
#include "common/kernels/quads.hpp"

/// Declares the kernels of one code path. The files that define them are compiled once per path with that
/// path's instruction set, and must share nothing else: an inline function of the standard library or of
/// Eigen, emitted in one of them, could be the copy that the linker keeps for the whole program, and would
/// stop an older processor. So they use raw pointers and functions without external linkage only.
#define PALPATE_DECLARE_KERNELS(level)                                                                                \
  namespace palpate::kernels::level {                                                                                 \
  void combine_f(const float* const* columns, const float* coefficient, int count, std::ptrdiff_t rows, float* out);  \
  void combine_d(const double* const* columns, const double* coefficient, int count, std::ptrdiff_t rows,             \
                 double* out);                                                                                        \
  void combine_nodes_d(const double* const* columns, const double* coefficient, int count, const int* nodes,          \
                       int node_count, double* out);                                                                  \
  int cholesky(double* a, int n, std::ptrdiff_t ld, const double* floor);                                             \
  void cholesky_solve(const double* l, int n, std::ptrdiff_t ld, double* x);                                          \
  int cholesky_append(double* l, int n, std::ptrdiff_t ld, const double* rows, std::ptrdiff_t row_stride, int k,      \
                      const double* floor);                                                                           \
  void cholesky_remove(double* l, int n, std::ptrdiff_t ld, int first, int k, double* scratch);                       \
  void rk4_first_f(const EdgeBlocks<float>& k, const NodeArrays<float>& nodes, double damping);                       \
  void rk4_first_d(const EdgeBlocks<double>& k, const NodeArrays<double>& nodes, double damping);                     \
  void rk4_second_f(const EdgeBlocks<float>& k, const NodeArrays<float>& nodes, double damping, double step);         \
  void rk4_second_d(const EdgeBlocks<double>& k, const NodeArrays<double>& nodes, double damping, double step);       \
  void semi_implicit_f(const EdgeBlocks<float>& k, const NodeArrays<float>& nodes, double damping, double step);      \
  void semi_implicit_d(const EdgeBlocks<double>& k, const NodeArrays<double>& nodes, double damping, double step);    \
  void forward_euler_f(const EdgeBlocks<float>& k, const NodeArrays<float>& nodes, double damping, double step);      \
  void forward_euler_d(const EdgeBlocks<double>& k, const NodeArrays<double>& nodes, double damping, double step);    \
  void patch_rk4_first_f(const PatchRows<float>& k, const NodeArrays<float>& nodes, double damping);                  \
  void patch_rk4_first_d(const PatchRows<double>& k, const NodeArrays<double>& nodes, double damping);                \
  void patch_rk4_second_f(const PatchRows<float>& k, const NodeArrays<float>& nodes, double damping, double step);    \
  void patch_rk4_second_d(const PatchRows<double>& k, const NodeArrays<double>& nodes, double damping, double step);  \
  void patch_semi_implicit_f(const PatchRows<float>& k, const NodeArrays<float>& nodes, double damping, double step); \
  void patch_semi_implicit_d(const PatchRows<double>& k, const NodeArrays<double>& nodes, double damping,             \
                             double step);                                                                            \
  void patch_forward_euler_f(const PatchRows<float>& k, const NodeArrays<float>& nodes, double damping, double step); \
  void patch_forward_euler_d(const PatchRows<double>& k, const NodeArrays<double>& nodes, double damping,             \
                             double step);                                                                            \
  void springs_f(const SpringQuad<float>* quads, int count, const float* u, float* force);                            \
  void springs_d(const SpringQuad<double>* quads, int count, const double* u, double* force);                         \
  void corotated_f(const TetQuad<float>* quads, int count, const float* u, float* force);                             \
  void corotated_d(const TetQuad<double>* quads, int count, const double* u, double* force);                          \
  void kernel_moments(const double* s, const double* t, const double* normal, double poisson, double* out);           \
  }

PALPATE_DECLARE_KERNELS(base)
PALPATE_DECLARE_KERNELS(v3)
PALPATE_DECLARE_KERNELS(v4)
