#include "common/mesh/gmsh_library.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <stdexcept>

#include "common/mesh/child.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

constexpr int kTriangle = 2, kTetrahedron = 4, kPoint = 15;

// Child processes only: this state is never undone, the process ends.
void start_library() {
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.NumThreads", 1);
}

std::vector<std::size_t> element_nodes(int type) {
  std::vector<std::size_t> elements, nodes;
  gmsh::model::mesh::getElementsByType(type, elements, nodes);
  return nodes;
}

void put_text(std::string& bytes, const std::string& text) {
  put(bytes, text.size());
  bytes += text;
}

std::string take_text(const std::string& bytes, std::size_t& at) {
  const auto size = take<std::size_t>(bytes, at);
  at += size;
  return bytes.substr(at - size, size);
}

std::string read_in_child(const std::filesystem::path& file) {
  start_library();
  try {
    gmsh::merge(file.string());
  } catch (const std::string& reason) {
    throw std::runtime_error("the gmsh library refuses it: " + reason);
  }
  std::string answer;
  std::vector<std::size_t> numbers;
  std::vector<double> coordinates, unused;
  gmsh::model::mesh::getNodes(numbers, coordinates, unused, -1, -1, false, false);
  put_all(answer, numbers);
  put_all(answer, coordinates);
  put_all(answer, element_nodes(kTetrahedron));
  put_all(answer, element_nodes(kTriangle));

  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups);
  put(answer, groups.size());
  for (const auto& [dimension, number] : groups) {
    std::string name;
    gmsh::model::getPhysicalName(dimension, number, name);
    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(dimension, number, entities);
    put(answer, dimension);
    put(answer, number);
    put_text(answer, name);
    put_all(answer, entities);
  }
  return answer;
}

template <std::size_t N>
std::vector<std::array<std::uint64_t, N>> in_groups_of(const std::vector<std::size_t>& flat) {
  std::vector<std::array<std::uint64_t, N>> groups(flat.size() / N);
  for (std::size_t i = 0; i < groups.size(); ++i) std::copy_n(flat.begin() + N * i, N, groups[i].begin());
  return groups;
}

std::vector<Eigen::Vector3d> as_points(const std::vector<double>& flat) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i + 2 < flat.size(); i += 3) points.emplace_back(flat[i], flat[i + 1], flat[i + 2]);
  return points;
}

std::vector<double> as_numbers(const std::vector<Eigen::Vector3d>& points) {
  std::vector<double> flat;
  for (const auto& x : points) flat.insert(flat.end(), {x.x(), x.y(), x.z()});
  return flat;
}

std::vector<std::size_t> one_to(std::size_t count) {
  std::vector<std::size_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = i + 1;
  return numbers;
}

/// Entities by dimension and by the set of groups (numbers) that their elements belong to.
class EntityTable {
 public:
  int entity(int dimension, const std::vector<int>& groups) {
    const auto [place, is_new] = entities_.emplace(std::pair(dimension, groups), 0);
    if (is_new) {
      place->second = ++count_[dimension];
      gmsh::model::addDiscreteEntity(dimension, place->second);
      for (int group : groups) members_[{dimension, group}].push_back(place->second);
    }
    return place->second;
  }

  void name_groups(const std::vector<std::string>& names) const {
    for (const auto& [group, entities] : members_) {
      gmsh::model::addPhysicalGroup(group.first, entities, group.second);
      gmsh::model::setPhysicalName(group.first, group.second, names[group.second - 1]);
    }
  }

 private:
  std::map<std::pair<int, std::vector<int>>, int> entities_;
  std::map<int, int> count_;
  std::map<std::pair<int, int>, std::vector<int>> members_;
};

// Of each item (tetrahedron, surface triangle, node) the numbers of the groups that it is written for.
using Memberships = std::vector<std::vector<int>>;

bool holds_all(const std::vector<int>& sorted, const std::array<int, 3>& nodes) {
  return std::all_of(nodes.begin(), nodes.end(),
                     [&](int n) { return std::binary_search(sorted.begin(), sorted.end(), n); });
}

// A group without tetrahedra is written as surface triangles where they cover its nodes, else as points.
void place_node_group(int number, const std::vector<int>& nodes, const Surface& surface, Memberships& triangles,
                      Memberships& points) {
  std::vector<int> covered;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    if (!holds_all(nodes, surface.triangles[i])) continue;
    chosen.push_back(i);
    covered.insert(covered.end(), surface.triangles[i].begin(), surface.triangles[i].end());
  }
  std::sort(covered.begin(), covered.end());
  covered.erase(std::unique(covered.begin(), covered.end()), covered.end());
  if (covered == nodes) {
    for (std::size_t i : chosen) triangles[i].push_back(number);
  } else {
    for (int n : nodes) points[n].push_back(number);
  }
}

template <class Nodes>
void add_elements(EntityTable& table, int dimension, int type, const std::vector<Nodes>& items,
                  const Memberships& groups, bool also_without_group) {
  std::map<int, std::vector<std::size_t>> nodes_of_entity;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (groups[i].empty() && !also_without_group) continue;
    auto& nodes = nodes_of_entity[table.entity(dimension, groups[i])];
    for (int n : items[i]) nodes.push_back(static_cast<std::size_t>(n) + 1);
  }
  for (const auto& [entity, nodes] : nodes_of_entity) gmsh::model::mesh::addElementsByType(entity, type, {}, nodes);
}

void build_model(const TetMesh& mesh, bool group_all) {
  const Surface surface = extract_surface(mesh);
  Memberships tetrahedra(mesh.tetrahedra.size()), triangles(surface.triangles.size()), points(mesh.nodes.size());
  std::vector<std::string> names;
  for (const auto& [name, group] : mesh.groups) {
    names.push_back(name);
    const int number = static_cast<int>(names.size());
    for (int t : group.tetrahedra) tetrahedra[t].push_back(number);
    if (group.tetrahedra.empty()) place_node_group(number, group.nodes, surface, triangles, points);
  }
  names.push_back("ungrouped");
  for (auto& groups : tetrahedra) {
    if (group_all && groups.empty()) groups.push_back(static_cast<int>(names.size()));
  }

  EntityTable table;
  const int first = table.entity(3, tetrahedra[0]);
  gmsh::model::mesh::addNodes(3, first, one_to(mesh.nodes.size()), as_numbers(mesh.nodes));
  std::vector<std::array<int, 1>> nodes(mesh.nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) nodes[n][0] = static_cast<int>(n);
  add_elements(table, 3, kTetrahedron, mesh.tetrahedra, tetrahedra, true);
  add_elements(table, 2, kTriangle, surface.triangles, triangles, false);
  add_elements(table, 0, kPoint, nodes, points, false);
  table.name_groups(names);
}

}  // namespace

LibraryMesh read_with_library(const std::filesystem::path& file) {
  const std::string answer = run_in_child([&] { return read_in_child(file); });
  LibraryMesh mesh;
  std::size_t at = 0;
  mesh.node_numbers = take_all<std::size_t>(answer, at);
  mesh.nodes = as_points(take_all<double>(answer, at));
  mesh.tetrahedra = in_groups_of<4>(take_all<std::size_t>(answer, at));
  mesh.triangles = in_groups_of<3>(take_all<std::size_t>(answer, at));
  const auto groups = take<std::size_t>(answer, at);
  for (std::size_t g = 0; g < groups; ++g) {
    const int dimension = take<int>(answer, at), number = take<int>(answer, at);
    const std::string name = take_text(answer, at);
    if (!name.empty()) mesh.group_names[{dimension, number}] = name;
    for (int entity : take_all<int>(answer, at)) mesh.groups_of_entity[{dimension, entity}].push_back(number);
  }
  return mesh;
}

void write_with_library(const TetMesh& mesh, const std::filesystem::path& file, double version, bool binary) {
  run_in_child([&] {
    start_library();
    gmsh::model::add("palpate");
    // Before version 4, elements carry their groups' numbers only where nothing but groups is saved.
    const bool by_group = version < 4 && file.extension() == ".msh";
    build_model(mesh, by_group);
    gmsh::option::setNumber("Mesh.SaveAll", by_group ? 0 : 1);
    gmsh::option::setNumber("Mesh.MshFileVersion", version);
    gmsh::option::setNumber("Mesh.Binary", binary ? 1 : 0);
    gmsh::write(file.string());
    return std::string();
  });
}

TetMesh fill_with_library(const TriangleMesh& surface, double size) {
  const std::string answer = run_in_child([&] {
    start_library();
    gmsh::model::add("palpate");
    gmsh::model::addDiscreteEntity(2, 1);
    gmsh::model::mesh::addNodes(2, 1, one_to(surface.nodes.size()), as_numbers(surface.nodes));
    std::vector<std::size_t> corners;
    for (const auto& t : surface.triangles) {
      for (int n : t) corners.push_back(static_cast<std::size_t>(n) + 1);
    }
    gmsh::model::mesh::addElementsByType(1, kTriangle, {}, corners);
    gmsh::model::geo::addSurfaceLoop({1}, 1);
    gmsh::model::geo::addVolume({1}, 1);
    gmsh::model::geo::synchronize();
    // Delaunay: unlike HXT it gives the same mesh in every process.
    gmsh::option::setNumber("Mesh.Algorithm3D", 1);
    gmsh::option::setNumber("Mesh.OptimizeThreshold", 0.5);
    gmsh::option::setNumber("Mesh.MeshSizeMax", size);
    gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
    gmsh::model::mesh::generate(3);
    std::vector<std::size_t> numbers;
    std::vector<double> coordinates, unused;
    gmsh::model::mesh::getNodes(numbers, coordinates, unused, -1, -1, false, false);
    std::string bytes;
    put_all(bytes, numbers);
    put_all(bytes, coordinates);
    put_all(bytes, element_nodes(kTetrahedron));
    return bytes;
  });
  std::size_t at = 0;
  const auto numbers = take_all<std::size_t>(answer, at);
  const auto points = as_points(take_all<double>(answer, at));
  const auto tetrahedra = in_groups_of<4>(take_all<std::size_t>(answer, at));

  // Nodes 1.. of the surface keep their numbers; the library numbers its own behind them.
  std::map<std::uint64_t, Eigen::Vector3d> by_number;
  for (std::size_t i = 0; i < numbers.size(); ++i) by_number[numbers[i]] = points[i];
  std::map<std::uint64_t, int> position;
  TetMesh mesh;
  for (const auto& [number, x] : by_number) {
    position[number] = static_cast<int>(mesh.nodes.size());
    mesh.nodes.push_back(x);
  }
  for (const auto& t : tetrahedra) {
    mesh.tetrahedra.push_back({position.at(t[0]), position.at(t[1]), position.at(t[2]), position.at(t[3])});
  }
  return mesh;
}

}  // namespace palpate
