#pragma once
#include <string>
#include <vector>

#include "common/fem/solid_spec.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// Node numbers that a selector names, ascending, each once. Nodes that no tetrahedron uses are left out.
/// `where` names the place in error sentences. Throws std::runtime_error on a number out of range or an
/// unknown group; an empty result is the caller's to judge.
std::vector<int> select_nodes(const TetMesh& mesh, const Selector& selector, const std::string& where);

/// The same among any nodes of which `used` says which ones elements use.
std::vector<int> select_nodes(const std::vector<Eigen::Vector3d>& nodes, const std::map<std::string, MeshGroup>& groups,
                              const std::vector<char>& used, const Selector& selector, const std::string& where);

/// Tetrahedra that a selector names: by number, by group, or with the centroid inside the box.
std::vector<int> select_elements(const TetMesh& mesh, const Selector& selector, const std::string& where);

/// True per node where at least one tetrahedron uses it.
std::vector<char> used_nodes(const TetMesh& mesh);

}  // namespace palpate
