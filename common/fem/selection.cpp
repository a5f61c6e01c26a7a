#include "common/fem/selection.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "common/mesh/group_names.hpp"

namespace palpate {
namespace {

using Groups = std::map<std::string, MeshGroup>;

const MeshGroup& find_group(const Groups& groups, const std::string& name, const std::string& where) {
  const auto found = groups.find(name);
  if (found != groups.end()) return found->second;
  throw std::runtime_error(fmt::format(
      "{}: the mesh has no group '{}' ({})", where, name,
      groups.empty() ? "it has no groups" : fmt::format("it has {}", fmt::join(group_names(groups), ", "))));
}

bool contains(const Box& box, const Eigen::Vector3d& point) {
  return (point.array() >= box.min.array()).all() && (point.array() <= box.max.array()).all();
}

void check_range(const std::vector<int>& indices, int count, const char* kind, const std::string& where) {
  for (int index : indices)
    if (index < 0 || index >= count)
      throw std::runtime_error(
          fmt::format("{}: {} {} is not in the mesh, which has {} (0 to {})", where, kind, index, count, count - 1));
}

void sort_unique(std::vector<int>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

std::vector<char> used_nodes(const TetMesh& mesh) {
  std::vector<char> used(mesh.nodes.size(), 0);
  for (const auto& tet : mesh.tetrahedra)
    for (int node : tet) used[node] = 1;
  return used;
}

std::vector<int> select_nodes(const std::vector<Eigen::Vector3d>& nodes, const Groups& groups,
                              const std::vector<char>& used, const Selector& selector, const std::string& where) {
  std::vector<int> selected = selector.indices;
  check_range(selected, static_cast<int>(nodes.size()), "node", where);
  if (selector.box)
    for (int i = 0; i < static_cast<int>(nodes.size()); ++i)
      if (contains(*selector.box, nodes[i])) selected.push_back(i);
  if (!selector.group.empty()) {
    const auto& group = find_group(groups, selector.group, where).nodes;
    selected.insert(selected.end(), group.begin(), group.end());
  }
  sort_unique(selected);
  std::erase_if(selected, [&](int node) { return !used[node]; });
  return selected;
}

std::vector<int> select_nodes(const TetMesh& mesh, const Selector& selector, const std::string& where) {
  return select_nodes(mesh.nodes, mesh.groups, used_nodes(mesh), selector, where);
}

std::vector<int> select_elements(const TetMesh& mesh, const Selector& selector, const std::string& where) {
  std::vector<int> elements = selector.indices;
  check_range(elements, static_cast<int>(mesh.tetrahedra.size()), "element", where);
  if (selector.box)
    for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int node : mesh.tetrahedra[e]) sum += mesh.nodes[node];
      if (contains(*selector.box, sum / 4)) elements.push_back(e);
    }
  if (!selector.group.empty()) {
    const auto& group = find_group(mesh.groups, selector.group, where).tetrahedra;
    elements.insert(elements.end(), group.begin(), group.end());
  }
  sort_unique(elements);
  return elements;
}

}  // namespace palpate
