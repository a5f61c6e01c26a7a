#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "common/fem/selection.hpp"
#include "common/mesh/surface.hpp"
#include "common/models/solid/precompute.hpp"

namespace palpate {
namespace {

bool any_free(const DofMap& dofs, int node) {
  return dofs.is_free(node, 0) || dofs.is_free(node, 1) || dofs.is_free(node, 2);
}

std::vector<char> touchable_mask(const SolidSpec& body, const TetMesh& mesh, const DofMap& dofs,
                                 const Surface& surface) {
  std::vector<char> allowed(mesh.nodes.size(), !body.touchable);
  const std::string place = fmt::format("body '{}': [body.touchable]", body.name);
  if (body.touchable)
    for (int node : select_nodes(mesh, *body.touchable, place)) allowed[node] = 1;
  std::vector<char> touchable(mesh.nodes.size(), 0);
  for (int node : surface.nodes) touchable[node] = allowed[node] && any_free(dofs, node);
  if (std::find(touchable.begin(), touchable.end(), 1) == touchable.end())
    throw std::runtime_error(place + " selects no free node of the surface");
  return touchable;
}

/// The given nodes that the surface lacks, ascending.
std::vector<int> inner_nodes(const Surface& surface, std::vector<int> nodes) {
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  std::erase_if(nodes, [&](int node) { return std::binary_search(surface.nodes.begin(), surface.nodes.end(), node); });
  return nodes;
}

}  // namespace

SurfaceMap make_surface_map(const SolidSpec& body, const TetMesh& mesh, const DofMap& dofs,
                            const std::vector<int>& also) {
  const auto surface = extract_surface(mesh);
  const auto touchable = touchable_mask(body, mesh, dofs, surface);
  SurfaceMap map;
  map.node_number = surface.nodes;
  const auto rest = std::stable_partition(map.node_number.begin(), map.node_number.end(),
                                          [&](int node) { return touchable[node] != 0; });
  map.touchable = static_cast<int>(rest - map.node_number.begin());
  const auto inner = inner_nodes(surface, also);
  map.node_number.insert(map.node_number.end(), inner.begin(), inner.end());
  std::vector<int> index(mesh.nodes.size(), -1);
  for (int i = 0; i < static_cast<int>(map.node_number.size()); ++i) {
    const int node = map.node_number[i];
    index[node] = i;
    map.position.push_back(mesh.nodes[node]);
    map.fixed.push_back({!dofs.is_free(node, 0), !dofs.is_free(node, 1), !dofs.is_free(node, 2)});
  }
  for (const auto& triangle : surface.triangles)
    map.triangles.push_back({index[triangle[0]], index[triangle[1]], index[triangle[2]]});
  return map;
}

}  // namespace palpate
