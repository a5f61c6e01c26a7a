#pragma once
#include "common/archive/compliance.hpp"
#include "common/models/quasi_static/compress.hpp"

namespace palpate::testing {

/// The same archive with compressed tensors.
inline Archive compressed_copy(const Archive& dense) {
  const Compliance<double> compliance(dense, Compliance<double>::Rows::surface);
  Archive copy = dense;
  copy.compressed = compress(dense.surface, [&](std::span<const int> nodes) {
    Eigen::MatrixXd columns(3 * compliance.row_nodes(), 3 * static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t j = 0; j < nodes.size(); ++j)
      for (int i = 0; i < compliance.row_nodes(); ++i)
        columns.block<3, 3>(3 * i, 3 * static_cast<Eigen::Index>(j)) = compliance.block(i, nodes[j]);
    return columns;
  });
  copy.touchable_compliance.clear();
  copy.other_compliance.clear();
  return copy;
}

}  // namespace palpate::testing
