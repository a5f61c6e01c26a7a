#pragma once

/// Plain data of the products of a symmetric 3x3 block matrix with two vectors at once, and of the time steps
/// that they serve. A node holds eight scalars, two vectors side by side: [x y z 0 | x y z 0].
namespace palpate::kernels {

constexpr int kNodeWidth = 8;
constexpr int kBlockSize = 9;

/// A symmetric matrix K of 3x3 blocks whose block rows sum to zero, by its blocks above the diagonal alone:
/// (K x)_i = sum over j of K_ij (x_j - x_i). Rows are nodes; a rigid translation gives exactly nothing, in
/// any precision.
template <class Scalar>
struct EdgeBlocks {
  int rows;
  const int* begin;     ///< rows + 1 entries: the blocks of row i are begin[i] .. begin[i + 1)
  const int* column;    ///< j > i of each block
  const Scalar* block;  ///< K_ij, 9 scalars column-major each; three more behind the last are readable
};

/// Node arrays of a step of M u'' + a M u' + K u = load, eight scalars a node.
template <class Scalar>
struct NodeArrays {
  Scalar* motion;          ///< [u | v]
  Scalar* rates;           ///< [v' | v''], from the first pass of RK4 to the second
  Scalar* product;         ///< forces of others [-N] before a pass, in the layout of what is multiplied; zero after it
  const Scalar* response;  ///< [1/m | load/m]; zero along fixed axes
};

}  // namespace palpate::kernels
