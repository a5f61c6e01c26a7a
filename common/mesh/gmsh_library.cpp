#include "common/mesh/gmsh_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>

#include "common/mesh/child.hpp"
#include "common/mesh/gmsh_calls.hpp"
#include "common/mesh/kept_reading.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

constexpr int kTriangle = 2, kTetrahedron = 4, kPoint = 15;

/// Where the program lies, as all its parts do, or above a library that this code is in; else wherever the loader
/// finds it.
std::string module_file() {
  const std::string name = "libpalpate_gmsh.so";
  std::error_code error;
  const auto below = [&](const std::filesystem::path& folder) { return folder / "lib/palpate" / name; };
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto file = below(program.parent_path().parent_path());
  if (std::filesystem::exists(file, error)) return file;
  Dl_info here{};
  if (!dladdr(reinterpret_cast<const void*>(&module_file), &here)) return name;
  for (auto folder = std::filesystem::absolute(here.dli_fname).parent_path(); folder != folder.root_path();
       folder = folder.parent_path())
    if (std::filesystem::exists(below(folder), error)) return below(folder);
  return name;
}

/// gmsh's calls, loaded with all that it links where the first one is made.
const LibraryCalls& calls() {
  static const LibraryCalls* const loaded = [] {
    void* const module = dlopen(module_file().c_str(), RTLD_LAZY | RTLD_LOCAL);
    void* const entry = module ? dlsym(module, "palpate_gmsh_calls") : nullptr;
    if (!entry) throw std::runtime_error(fmt::format("the gmsh library cannot be loaded: {}", dlerror()));
    return reinterpret_cast<decltype(&palpate_gmsh_calls)>(entry)();
  }();
  return *loaded;
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
  explicit EntityTable(LibraryModel& model) : model_(model) {}

  LibraryEntity& entity(int dimension, int type, const std::vector<int>& groups) {
    const auto [place, is_new] = places_.emplace(std::pair(dimension, groups), model_.entities.size());
    if (is_new) {
      model_.entities.push_back({dimension, ++count_[dimension], type, {}});
      for (int group : groups) members_[{dimension, group}].push_back(count_[dimension]);
    }
    return model_.entities[place->second];
  }

  void name_groups(const std::vector<std::string>& names) const {
    for (const auto& [group, entities] : members_)
      model_.groups.push_back({group.first, group.second, entities, names[group.second - 1]});
  }

 private:
  LibraryModel& model_;
  std::map<std::pair<int, std::vector<int>>, std::size_t> places_;
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
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (groups[i].empty() && !also_without_group) continue;
    auto& nodes = table.entity(dimension, type, groups[i]).nodes;
    for (int n : items[i]) nodes.push_back(static_cast<std::size_t>(n) + 1);
  }
}

LibraryModel model_of(const TetMesh& mesh, bool group_all) {
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

  LibraryModel model{one_to(mesh.nodes.size()), as_numbers(mesh.nodes), {}, {}};
  EntityTable table(model);
  std::vector<std::array<int, 1>> nodes(mesh.nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) nodes[n][0] = static_cast<int>(n);
  add_elements(table, 3, kTetrahedron, mesh.tetrahedra, tetrahedra, true);
  add_elements(table, 2, kTriangle, surface.triangles, triangles, false);
  add_elements(table, 0, kPoint, nodes, points, false);
  table.name_groups(names);
  return model;
}

std::string in_child(const std::function<std::string(const LibraryCalls&)>& work) {
  return run_in_child([&work, &gmsh = calls()] { return work(gmsh); });
}

/// What the library's `read` answered.
LibraryMesh mesh_of(const std::string& answer) {
  LibraryMesh mesh;
  std::size_t at = 0;
  mesh.node_numbers = take_all<std::size_t>(answer, at);
  mesh.nodes = as_points(take_all<double>(answer, at));
  mesh.tetrahedra = in_groups_of<4>(take_all<std::size_t>(answer, at));
  mesh.triangles = in_groups_of<3>(take_all<std::size_t>(answer, at));
  if (mesh.nodes.size() != mesh.node_numbers.size())
    throw std::runtime_error("the reader's answer does not fit together");
  const auto groups = take<std::size_t>(answer, at);
  for (std::size_t g = 0; g < groups; ++g) {
    const int dimension = take<int>(answer, at), number = take<int>(answer, at);
    const std::string name = take_text(answer, at);
    if (!name.empty()) mesh.group_names[{dimension, number}] = name;
    for (int entity : take_all<int>(answer, at)) mesh.groups_of_entity[{dimension, entity}].push_back(number);
  }
  return mesh;
}

/// None where nothing is kept that can be used.
std::optional<LibraryMesh> kept_mesh(const std::filesystem::path& place) {
  const auto answer = kept_answer(place);
  if (!answer) return {};
  try {
    return mesh_of(*answer);
  } catch (const std::runtime_error&) {
    return {};
  }
}

}  // namespace

LibraryMesh read_with_library(const std::filesystem::path& file) {
  const auto place = reading_place(file);
  if (auto kept = place ? kept_mesh(*place) : std::nullopt) return *std::move(kept);
  const std::string answer = in_child([&](const LibraryCalls& gmsh) { return gmsh.read(file.string()); });
  LibraryMesh mesh = mesh_of(answer);
  if (place && place == reading_place(file)) keep_answer(*place, answer);  // unless the file changed meanwhile
  return mesh;
}

void write_with_library(const TetMesh& mesh, const std::filesystem::path& file, double version, bool binary) {
  // Before version 4, elements carry their groups' numbers only where nothing but groups is saved.
  const bool by_group = version < 4 && file.extension() == ".msh";
  in_child([&](const LibraryCalls& gmsh) {
    return gmsh.write(model_of(mesh, by_group), file.string(), {version, binary, by_group});
  });
}

TetMesh fill_with_library(const TriangleMesh& surface, double size) {
  LibraryModel model{one_to(surface.nodes.size()), as_numbers(surface.nodes), {{2, 1, kTriangle, {}}}, {}};
  for (const auto& t : surface.triangles) {
    for (int n : t) model.entities[0].nodes.push_back(static_cast<std::size_t>(n) + 1);
  }
  const std::string answer = in_child([&](const LibraryCalls& gmsh) { return gmsh.fill(model, size); });
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
