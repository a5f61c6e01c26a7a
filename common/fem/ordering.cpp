#include "common/fem/ordering.hpp"

#include "common/fem/cholmod_context.hpp"

namespace palpate {
namespace {

/// Pattern (lower triangle) of the graph restricted to the nodes with local number >= 0.
SparseMatrix induced_pattern(const NodeGraph& graph, const std::vector<int>& nodes, const std::vector<int>& local) {
  const auto n = static_cast<std::int64_t>(nodes.size());
  SparseMatrix pattern(n, n);
  pattern.reserve(static_cast<std::int64_t>(graph.neighbour.size()));
  for (std::int64_t column = 0; column < n; ++column) {
    pattern.startVec(column);
    for (auto at = graph.begin[nodes[column]]; at < graph.begin[nodes[column] + 1]; ++at)
      if (local[graph.neighbour[at]] >= 0) pattern.insertBack(local[graph.neighbour[at]], column) = 1;
  }
  pattern.finalize();
  return pattern;
}

std::vector<SuiteSparse_long> metis_postordered(const SparseMatrix& pattern) {
  CholmodContext context;
  auto view = cholmod_view(pattern);
  std::vector<SuiteSparse_long> order(pattern.rows());
  if (!cholmod_l_metis(&view, nullptr, 0, /*postorder=*/true, order.data(), context.get()))
    throw std::runtime_error("METIS could not order the unknowns");
  return order;
}

}  // namespace

std::vector<int> interior_first_order(const NodeGraph& graph, const std::vector<int>& last) {
  const std::size_t n = graph.begin.size() - 1;
  std::vector<int> local(n, 0), interior;
  for (int node : last) local[node] = -1;
  for (std::size_t node = 0; node < n; ++node) {
    if (local[node] < 0 || graph.begin[node] == graph.begin[node + 1]) continue;
    local[node] = static_cast<int>(interior.size());
    interior.push_back(static_cast<int>(node));
  }
  std::vector<int> order;
  order.reserve(interior.size() + last.size());
  if (!interior.empty())
    for (auto i : metis_postordered(induced_pattern(graph, interior, local))) order.push_back(interior[i]);
  order.insert(order.end(), last.begin(), last.end());
  return order;
}

std::vector<std::int64_t> dof_order(const DofMap& dofs, const std::vector<int>& node_order) {
  std::vector<std::int64_t> order;
  order.reserve(dofs.size());
  for (int node : node_order)
    for (int axis = 0; axis < 3; ++axis)
      if (dofs.is_free(node, axis)) order.push_back(dofs.index(node, axis));
  return order;
}

}  // namespace palpate
