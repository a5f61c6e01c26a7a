#include "common/models/hybrid/hybrid_split.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <stdexcept>

#include "common/fem/selection.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

using Face = std::array<int, 3>;

Face key_of(Face face) {
  std::sort(face.begin(), face.end());
  return face;
}

/// The dofs of a mesh that are free in `dofs`, and of nodes that `held` marks none.
DofMap dofs_of(const TetMesh& mesh, const DofMap& dofs, const std::vector<char>& held) {
  DofMap part(mesh);
  for (int node = 0; node < dofs.nodes(); ++node) {
    if (part.index(node, 0) == DofMap::kUnused) continue;
    for (int axis = 0; axis < 3; ++axis)
      if (!dofs.is_free(node, axis) || (!held.empty() && held[node])) part.fix(node, axis);
  }
  part.number();
  return part;
}

/// The tetrahedra piece by piece, pieces being joined by nodes.
std::vector<TetMesh> pieces(const TetMesh& mesh) {
  std::vector<int> parent(mesh.nodes.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int node) {
    while (parent[node] != node) node = parent[node] = parent[parent[node]];
    return node;
  };
  for (const auto& tet : mesh.tetrahedra)
    for (int node : tet) parent[root(node)] = root(tet[0]);
  std::map<int, TetMesh> by_root;
  for (const auto& tet : mesh.tetrahedra) by_root[root(tet[0])].tetrahedra.push_back(tet);
  std::vector<TetMesh> result;
  for (auto& [_, piece] : by_root) {
    piece.nodes = mesh.nodes;
    result.push_back(std::move(piece));
  }
  return result;
}

/// Sets held_by_connection, or throws.
void check_supports(const HybridSpec& body, const DofMap& dofs, HybridSplit& split) {
  for (const TetMesh& piece : pieces(split.quasi_static_mesh)) {
    if (remaining_rigid_motions(piece, dofs_of(piece, dofs, {})) == 0) continue;
    if (remaining_rigid_motions(piece, dofs_of(piece, dofs, split.connection)) > 0)
      throw std::runtime_error(
          fmt::format("body '{}': [body.hybrid] leaves {} quasi-static tetrahedra that would float: neither "
                      "fixed nodes nor the "
                      "nodes they share with the tensor-mass part hold them; fix more nodes, or draw the "
                      "regions otherwise",
                      body.name, piece.tetrahedra.size()));
    split.held_by_connection = true;
  }
}

}  // namespace

std::vector<int> dynamic_elements(const HybridSpec& body, const TetMesh& mesh) {
  std::vector<int> elements;
  for (std::size_t i = 0; i < body.hybrid.regions.size(); ++i) {
    const std::string place = fmt::format("body '{}': [[body.hybrid.region]] number {}", body.name, i + 1);
    const auto region = select_elements(mesh, body.hybrid.regions[i], place);
    if (region.empty()) throw std::runtime_error(place + " selects no element of the mesh");
    elements.insert(elements.end(), region.begin(), region.end());
  }
  std::sort(elements.begin(), elements.end());
  elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  return elements;
}

HybridSplit split_hybrid(const HybridSpec& body, const TetMesh& mesh, const DofMap& dofs, std::vector<int> dynamic) {
  const std::string place = fmt::format("body '{}': [body.hybrid]", body.name);
  const auto count = static_cast<int>(mesh.tetrahedra.size());
  if (dynamic.empty()) throw std::runtime_error(place + " leaves no tensor-mass part");
  if (static_cast<int>(dynamic.size()) == count)
    throw std::runtime_error(place + " leaves no quasi-static part: the regions hold every element of the mesh");
  std::vector<int> all(count), quasi_static;
  std::iota(all.begin(), all.end(), 0);
  std::set_difference(all.begin(), all.end(), dynamic.begin(), dynamic.end(), std::back_inserter(quasi_static));

  TetMesh part;
  part.nodes = mesh.nodes;
  std::vector<char> of_dynamic(mesh.nodes.size(), 0), connection(mesh.nodes.size(), 0);
  for (int e : dynamic)
    for (int node : mesh.tetrahedra[e]) of_dynamic[node] = 1;
  for (int e : quasi_static) {
    part.tetrahedra.push_back(mesh.tetrahedra[e]);
    for (int node : mesh.tetrahedra[e]) connection[node] = of_dynamic[node];
  }
  if (std::find(connection.begin(), connection.end(), 1) == connection.end())
    throw std::runtime_error(place + ": the tensor-mass part and the quasi-static part share no node");
  auto free = dofs_of(part, dofs, {}), inner = dofs_of(part, dofs, connection);
  HybridSplit split{std::move(dynamic),    std::move(quasi_static), std::move(part),
                    std::move(connection), std::move(free),         std::move(inner)};
  check_supports(body, dofs, split);
  return split;
}

std::vector<std::array<int, 4>> interface_faces(const TetMesh& mesh, const HybridSplit& split,
                                                const std::vector<int>& index) {
  std::map<Face, int> facet_of;  // of dynamic faces whose nodes are all connection nodes
  for (int t = 0; t < static_cast<int>(split.dynamic.size()); ++t) {
    const auto& tet = mesh.tetrahedra[split.dynamic[t]];
    for (int f = 0; f < 4; ++f) {
      const Face face{tet[kTetFaces[f][0]], tet[kTetFaces[f][1]], tet[kTetFaces[f][2]]};
      if (split.connection[face[0]] && split.connection[face[1]] && split.connection[face[2]])
        facet_of[key_of(face)] = 4 * t + f;
    }
  }
  std::vector<std::array<int, 4>> interface;
  for (const Face& face : extract_surface(split.quasi_static_mesh).triangles) {
    const auto found = facet_of.find(key_of(face));
    if (found != facet_of.end()) interface.push_back({index[face[0]], index[face[1]], index[face[2]], found->second});
  }
  return interface;
}

}  // namespace palpate
