#pragma once
#include "common/kernels/block_rows.hpp"

/// Plain data of products with the stiffness of NodalPatches (common/fem/nodal_patches.hpp), patch by patch and then
/// node by node. Lists are filled up with zeros to even lengths: they are read in pairs.
namespace palpate::kernels {

constexpr int kTieSize = 4;
constexpr int kStressSize = 3 * kNodeWidth;

/// Nodes are rows, as in EdgeBlocks. A rigid translation gives exactly nothing, in any precision.
template <class Scalar>
struct PatchRows {
  int patches, rows;
  const int* node;      ///< row of each patch's own node
  const int* begin;     ///< patches + 1 entries: the ties of patch p are begin[p] .. begin[p + 1), an even number
  const int* column;    ///< kNodeWidth times the row of each tie's other node
  const Scalar* tie;    ///< G [m^2] of the other node and w [N/m], four scalars each
  const Scalar* patch;  ///< lambda/V, mu/V, c/V [Pa/m^3] and 0 each; zeros where nothing is left
  const int* first;     ///< rows + 1 entries: the patches of row i are first[i] .. first[i + 1), an even number
  const int* member;    ///< kStressSize times each of them
  const Scalar* share;  ///< G [m^2] of the row's node there and 0, four scalars each
  Scalar* stress;       ///< kStressSize scalars a patch: scratch
};

}  // namespace palpate::kernels
