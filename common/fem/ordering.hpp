#pragma once
#include <cstdint>
#include <vector>

#include "common/fem/assembly.hpp"

namespace palpate {

/// An elimination order of the used nodes that keeps `last` at the end, in the order given; the others come
/// first, ordered by METIS on the node graph (a ninth of the entries of the matrix) and postordered, so that
/// supernodes are contiguous.
std::vector<int> interior_first_order(const NodeGraph& graph, const std::vector<int>& last);

/// The same order over free dofs.
std::vector<std::int64_t> dof_order(const DofMap& dofs, const std::vector<int>& node_order);

}  // namespace palpate
