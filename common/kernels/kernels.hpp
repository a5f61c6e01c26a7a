#pragma once
#include <cstddef>
#include <new>
#include <string_view>
#include <vector>

#include "common/kernels/block_rows.hpp"
#include "common/kernels/patch_rows.hpp"
#include "common/kernels/quads.hpp"

/// The hot dense loops, compiled once per vector width and chosen when the program starts. Nothing here
/// allocates. Everything is deterministic for a given code path: same input, same bits; another path may
/// round differently.
///
/// Factors are column-major in a buffer of leading_dimension(N) x N doubles, N being the largest order in
/// use. Only the lower triangle (row >= column) of the leading n x n part means anything: the kernels write
/// whole vectors, so that the rows below n are scratch, and so is the part above the diagonal, new columns
/// included.
namespace palpate::kernels {

/// Most rows that one call of cholesky_append or cholesky_remove takes: three contacts of three axes.
constexpr int kMaxBlock = 9;

/// Leading dimension for factors up to the given order: room for whole vectors, lines that do not alias.
constexpr std::ptrdiff_t leading_dimension(int max_order) {
  const std::ptrdiff_t rounded = (max_order + 16 + 7) / 8 * 8;
  return rounded % 64 == 0 ? rounded + 8 : rounded;
}

/// Takes memory on whole cache lines: vectors that straddle two lines cost twice.
template <class T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kAlignment{64};
  LineAllocator() = default;
  template <class U>
  LineAllocator(const LineAllocator<U>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kAlignment)); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, kAlignment); }
  template <class U>
  bool operator==(const LineAllocator<U>&) const {
    return true;
  }
};

/// What factors are best kept in; any other memory works too.
using Buffer = std::vector<double, LineAllocator<double>>;

/// One compiled set.
struct Table {
  std::string_view name;  ///< "x86-64", "x86-64-v3" (AVX2, FMA) or "x86-64-v4" (AVX-512)

  /// out[0..rows) = sum over i < count of coefficient[i] * columns[i][0..rows). Single precision.
  void (*combine_f)(const float* const* columns, const float* coefficient, int count, std::ptrdiff_t rows, float* out);
  /// The same in double precision.
  void (*combine_d)(const double* const* columns, const double* coefficient, int count, std::ptrdiff_t rows,
                    double* out);
  /// The same for some nodes only, three rows each:
  /// out[3m + a] = sum over i < count of coefficient[i] * columns[i][3 nodes[m] + a], a = 0, 1, 2.
  void (*combine_nodes_d)(const double* const* columns, const double* coefficient, int count, const int* nodes,
                          int node_count, double* out);

  /// Lower Cholesky factor L of a, n x n, in place. A pivot (the square of L's diagonal entry) below floor[i]
  /// > 0, or not a number, is raised to floor[i]: the factor is then that of A plus a compliance of (floor[i]
  /// - pivot) on that row's diagonal, which keeps the solution bounded where rows repeat each other. Returns
  /// how many were raised.
  int (*cholesky)(double* a, int n, std::ptrdiff_t ld, const double* floor);
  /// Solves L L^T x = b in place.
  void (*cholesky_solve)(const double* l, int n, std::ptrdiff_t ld, double* x);
  /// Appends k <= kMaxBlock rows to an n x n factor: `rows` holds the new rows of A, k x (n+k) by rows with
  /// stride `row_stride` (of the new diagonal block, the lower triangle is read). floor[i] belongs to new row
  /// i; pivots as in cholesky. Returns how many were raised.
  int (*cholesky_append)(double* l, int n, std::ptrdiff_t ld, const double* rows, std::ptrdiff_t row_stride, int k,
                         const double* floor);
  /// Removes rows and columns [first, first+k) of A, k <= kMaxBlock, from its n x n factor, which becomes
  /// (n-k) x (n-k): a positive rank-k update of the trailing part by reflections, all k columns in one pass.
  /// What a raised pivot added within the removed rows goes with them; elsewhere it stays.
  /// `scratch`: k * ld doubles.
  void (*cholesky_remove)(double* l, int n, std::ptrdiff_t ld, int first, int k, double* scratch);

  /// One step of classical RK4 in two passes over the blocks. With loads that stay constant the step is the Taylor
  /// polynomial of degree four, whose products with K pair up: the first pass takes [u | v] and leaves v' = M^-1
  /// (load - K u) - a v and v'' = -M^-1 K v - a v' in `rates`; the second takes those and moves u and v on by `step`
  /// [s]. `damping` is a [1/s]. Forces of others stand in `product` before each pass, for the same two vectors.
  void (*rk4_first_f)(const EdgeBlocks<float>& k, const NodeArrays<float>& nodes, double damping);
  void (*rk4_first_d)(const EdgeBlocks<double>& k, const NodeArrays<double>& nodes, double damping);
  void (*rk4_second_f)(const EdgeBlocks<float>& k, const NodeArrays<float>& nodes, double damping, double step);
  void (*rk4_second_d)(const EdgeBlocks<double>& k, const NodeArrays<double>& nodes, double damping, double step);
  /// One step of semi-implicit Euler (the new velocity moves the node) or of forward Euler (the old one does).
  void (*semi_implicit_f)(const EdgeBlocks<float>& k, const NodeArrays<float>& nodes, double damping, double step);
  void (*semi_implicit_d)(const EdgeBlocks<double>& k, const NodeArrays<double>& nodes, double damping, double step);
  void (*forward_euler_f)(const EdgeBlocks<float>& k, const NodeArrays<float>& nodes, double damping, double step);
  void (*forward_euler_d)(const EdgeBlocks<double>& k, const NodeArrays<double>& nodes, double damping, double step);

  /// The same steps with the stiffness of patches: `k` in place of the blocks.
  void (*patch_rk4_first_f)(const PatchRows<float>& k, const NodeArrays<float>& nodes, double damping);
  void (*patch_rk4_first_d)(const PatchRows<double>& k, const NodeArrays<double>& nodes, double damping);
  void (*patch_rk4_second_f)(const PatchRows<float>& k, const NodeArrays<float>& nodes, double damping, double step);
  void (*patch_rk4_second_d)(const PatchRows<double>& k, const NodeArrays<double>& nodes, double damping, double step);
  void (*patch_semi_implicit_f)(const PatchRows<float>& k, const NodeArrays<float>& nodes, double damping, double step);
  void (*patch_semi_implicit_d)(const PatchRows<double>& k, const NodeArrays<double>& nodes, double damping,
                                double step);
  void (*patch_forward_euler_f)(const PatchRows<float>& k, const NodeArrays<float>& nodes, double damping, double step);
  void (*patch_forward_euler_d)(const PatchRows<double>& k, const NodeArrays<double>& nodes, double damping,
                                double step);

  /// Adds the forces of springs [N] to `force` at displacements `u` [m], see SpringQuad.
  void (*springs_f)(const SpringQuad<float>* quads, int count, const float* u, float* force);
  void (*springs_d)(const SpringQuad<double>* quads, int count, const double* u, double* force);
  /// Adds the forces of corotated tetrahedra, see TetQuad: linear elasticity in each element's own rotated frame.
  void (*corotated_f)(const TetQuad<float>* quads, int count, const float* u, float* force);
  void (*corotated_d)(const TetQuad<double>* quads, int count, const double* u, double* force);

  /// out[(3 a + b) 10 ..] = integral over triangle s of L_a(x), integral over t of L_b(y), K(x - y) dy dx [m^3], L
  /// being the barycentric coordinates and K = (1 - poisson)/r I + poisson/r^3 h h^T, h the part of x - y across
  /// `normal` (unit): the isotropic number, then xx, yy, zz, xy, xz, yz of the rest, and likewise of h / r^2 its x, y,
  /// z. `s`, `t`: x, y, z [m] of three corners each. Where the triangles are near each other the inner integral is
  /// taken in polar coordinates about x, in which 1/r is no singularity.
  void (*kernel_moments)(const double* s, const double* t, const double* normal, double poisson, double* out);
};

/// The code paths that this processor can run, widest last.
std::vector<const Table*> available();

/// The path in use: the widest available, unless $PALPATE_KERNELS or use() named another.
/// Throws std::runtime_error at the first call if $PALPATE_KERNELS names a path that this processor lacks.
const Table& active();

/// Chooses a path by name; call it at set-up, before threads start. Throws std::runtime_error if this
/// processor lacks it.
void use(std::string_view name);

}  // namespace palpate::kernels
