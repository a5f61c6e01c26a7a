#pragma once
#include "common/archive/archive.hpp"
#include "common/archive/compressed_compliance.hpp"

namespace palpate {

/// How a compressed compliance is to be cut into blocks.
struct BlockPlan {
  std::vector<int> order;  ///< as CompressedTensors::order
  int touchable = 0;
  /// As CompressedTensors::blocks, sorted by columns, which are leaves; rank 0 where clusters are far enough from each
  /// other for a low one, which is yet to be found.
  std::vector<ComplianceBlock> blocks;
};

/// Halves nodes along the longest side of their box down to leaves, the touchable ones and the others apart. Each leaf
/// is paired with the largest clusters behind it that are farther from it than a part of its own and of their width.
BlockPlan plan_blocks(const SurfaceMap& surface);

}  // namespace palpate
