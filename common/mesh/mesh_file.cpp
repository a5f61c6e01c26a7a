#include "common/mesh/mesh_file.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <stdexcept>
#include <unordered_map>

#include "common/mesh/fill.hpp"
#include "common/mesh/gmsh_library.hpp"
#include "common/mesh/listing.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

using std::filesystem::path;

[[noreturn]] void refuse(const path& file, const std::string& reason) {
  throw std::runtime_error(fmt::format("{}: {}", file.string(), reason));
}

std::string beginning_of(const path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text(16, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

// The library goes by the extension and takes unknown text for a script, so both have to fit.
void check_format(const path& file, bool surfaces_too) {
  if (!std::filesystem::exists(file)) refuse(file, "the file does not exist");
  if (!std::filesystem::is_regular_file(file)) refuse(file, "this is not a file");
  const std::string extension = file.extension().string(), text = beginning_of(file);
  if (extension == ".msh") {
    const bool known = text.starts_with("$NOD") || text.starts_with("$MeshFormat");
    if (!known) refuse(file, "it does not begin as a Gmsh mesh does, with $MeshFormat or $NOD");
  } else if (extension == ".vtk") {
    if (!text.starts_with("# vtk DataFile"))
      refuse(file, "it does not begin as a legacy VTK file does, with # vtk DataFile");
  } else if (extension != ".stl" || !surfaces_too) {
    refuse(file, surfaces_too ? "a surface is read from .msh, .vtk and .stl files"
                              : "a mesh is read from .msh and .vtk files");
  }
}

void check_scale(const path& file, double scale) {
  if (!(std::isfinite(scale) && scale > 0))
    refuse(file, fmt::format("the scale {} is not a positive number", scale));
}

LibraryMesh ask_library(const path& file) {
  try {
    return read_with_library(file);
  } catch (const std::runtime_error& error) {
    refuse(file, error.what());
  }
}

bool same(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  for (int i = 0; i < 3; ++i) {
    if (a[i] != b[i] && !(std::isnan(a[i]) && std::isnan(b[i]))) return false;
  }
  return true;
}

std::vector<std::array<int, 4>> sorted_set(std::vector<std::array<int, 4>> tetrahedra) {
  for (auto& t : tetrahedra) std::sort(t.begin(), t.end());
  std::sort(tetrahedra.begin(), tetrahedra.end());
  tetrahedra.erase(std::unique(tetrahedra.begin(), tetrahedra.end()), tetrahedra.end());
  return tetrahedra;
}

// The list of the file and the reading of the library must be the same mesh, whatever their order.
void check_agreement(const path& file, const FileListing& listing,
                     const std::vector<std::array<int, 4>>& tetrahedra, const LibraryMesh& library) {
  std::unordered_map<std::uint64_t, int> position;
  for (std::size_t i = 0; i < listing.node_numbers.size(); ++i)
    position[listing.node_numbers[i]] = static_cast<int>(i);
  bool agree = true;
  for (std::size_t i = 0; i < library.nodes.size() && agree; ++i) {
    const auto place = position.find(library.node_numbers[i]);
    agree = place != position.end() && same(listing.nodes[place->second], library.nodes[i]);
  }
  std::vector<std::array<int, 4>> read(library.tetrahedra.size());
  for (std::size_t t = 0; t < read.size() && agree; ++t) {
    for (int c = 0; c < 4 && agree; ++c) {
      const auto place = position.find(library.tetrahedra[t][c]);
      agree = place != position.end();
      if (agree) read[t][c] = place->second;
    }
  }
  if (!agree || sorted_set(std::move(read)) != sorted_set(tetrahedra)) {
    refuse(file, "its lists can be read in two ways, the file is damaged");
  }
}

struct GroupKey {
  int dimension, number;
  auto operator<=>(const GroupKey&) const = default;
};

void sort_unique(std::vector<int>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

void merge_into(MeshGroup& target, const MeshGroup& group) {
  target.nodes.insert(target.nodes.end(), group.nodes.begin(), group.nodes.end());
  target.tetrahedra.insert(target.tetrahedra.end(), group.tetrahedra.begin(), group.tetrahedra.end());
  sort_unique(target.nodes);
  sort_unique(target.tetrahedra);
}

std::map<GroupKey, MeshGroup> collect_groups(const FileListing& listing, const LibraryMesh& library) {
  std::map<GroupKey, MeshGroup> groups;
  int tetrahedron = 0;
  for (const ListedElement& element : listing.elements) {
    const int dimension = element_dimension(element.type), index = element.type == 4 ? tetrahedron++ : -1;
    std::vector<int> numbers = element.groups;
    if (listing.groups_by_entity) {
      const auto place = library.groups_of_entity.find({dimension, element.entity});
      if (place != library.groups_of_entity.end()) numbers = place->second;
    }
    for (int number : numbers) {
      MeshGroup& group = groups[{dimension, number}];
      group.nodes.insert(group.nodes.end(), element.nodes.begin(), element.nodes.end());
      if (index >= 0) group.tetrahedra.push_back(index);
    }
  }
  return groups;
}

void name_groups(const FileListing& listing, const LibraryMesh& library, TetMesh& mesh) {
  static constexpr const char* kKinds[] = {"point", "curve", "surface", "volume"};
  const std::map<GroupKey, MeshGroup> groups = collect_groups(listing, library);
  std::map<int, int> dimensions_of_number;
  for (const auto& [key, group] : groups) ++dimensions_of_number[key.number];
  for (const auto& [key, group] : groups) {
    const std::string number = std::to_string(key.number);
    const bool alone = dimensions_of_number[key.number] == 1;
    merge_into(mesh.groups[alone ? number : fmt::format("{} {}", kKinds[key.dimension], number)], group);
  }
  for (const auto& [key, group] : groups) {
    const auto name = library.group_names.find({key.dimension, key.number});
    if (name != library.group_names.end() && name->second != std::to_string(key.number)) {
      merge_into(mesh.groups[name->second], group);
    }
  }
}

void take_elements(const path& file, const FileListing& listing, TetMesh& mesh) {
  for (const ListedElement& element : listing.elements) {
    if (element.type == 4) {
      mesh.tetrahedra.push_back({element.nodes[0], element.nodes[1], element.nodes[2], element.nodes[3]});
    } else if (element_dimension(element.type) == 3) {
      refuse(file,
             fmt::format("it has solid elements of {} nodes; only tetrahedra of 4 nodes are computed with",
                         element.nodes.size()));
    }
  }
}

// A file that is negative throughout follows the opposite convention.
void turn_if_all_negative(TetMesh& mesh) {
  const bool all = std::all_of(mesh.tetrahedra.begin(), mesh.tetrahedra.end(), [&](const auto& t) {
    const bool in_range =
        std::all_of(t.begin(), t.end(), [&](int n) { return n < static_cast<int>(mesh.nodes.size()); });
    return in_range && tet_volume(mesh, t) < 0;
  });
  if (!all) return;
  for (auto& t : mesh.tetrahedra) std::swap(t[2], t[3]);
}

TriangleMesh boundary_of(const TetMesh& mesh) {
  return {mesh.nodes, extract_surface(mesh).triangles};
}

TriangleMesh drop_unused_nodes(const TriangleMesh& mesh) {
  TriangleMesh kept;
  std::vector<int> position(mesh.nodes.size(), -1);
  for (auto triangle : mesh.triangles) {
    for (int& n : triangle) {
      if (position[n] < 0) {
        position[n] = static_cast<int>(kept.nodes.size());
        kept.nodes.push_back(mesh.nodes[n]);
      }
      n = position[n];
    }
    kept.triangles.push_back(triangle);
  }
  return kept;
}

TriangleMesh triangles_of(const path& file, const LibraryMesh& library, double scale) {
  std::unordered_map<std::uint64_t, int> position;
  TriangleMesh mesh;
  for (std::size_t i = 0; i < library.nodes.size(); ++i) {
    position[library.node_numbers[i]] = static_cast<int>(i);
    mesh.nodes.push_back(scale * library.nodes[i]);
  }
  for (std::size_t i = 0; i < library.triangles.size(); ++i) {
    std::array<int, 3> triangle;
    for (int c = 0; c < 3; ++c) {
      const auto place = position.find(library.triangles[i][c]);
      if (place == position.end())
        refuse(file, fmt::format("triangle {}: one of its nodes does not exist", i));
      triangle[c] = place->second;
      if (!mesh.nodes[triangle[c]].allFinite()) {
        refuse(file, fmt::format("triangle {}: a coordinate is not a finite number", i));
      }
    }
    mesh.triangles.push_back(triangle);
  }
  return drop_unused_nodes(mesh);
}

// The library believes the count in a binary STL's header, so it has to fit the size.
void check_stl(const path& file) {
  if (beginning_of(file).starts_with("solid")) return;
  std::ifstream in(file, std::ios::binary);
  char header[80];
  std::uint32_t count = 0;
  in.read(header, sizeof header);
  in.read(reinterpret_cast<char*>(&count), sizeof count);
  if (!in || std::filesystem::file_size(file) < 84 + std::uintmax_t{50} * count) {
    refuse(file, "the file ends before its last triangle");
  }
}

}  // namespace

TetMesh load_tet_mesh(const path& file, double scale) {
  check_format(file, false);
  check_scale(file, scale);
  const FileListing listing = list_mesh_file(file);
  TetMesh mesh;
  for (const auto& x : listing.nodes) mesh.nodes.push_back(scale * x);
  take_elements(file, listing, mesh);
  const LibraryMesh library = ask_library(file);
  check_agreement(file, listing, mesh.tetrahedra, library);
  turn_if_all_negative(mesh);
  check_tet_mesh(mesh, file.string());
  name_groups(listing, library, mesh);
  return mesh;
}

TriangleMesh load_triangle_mesh(const path& file, double scale) {
  check_format(file, true);
  check_scale(file, scale);
  if (file.extension() == ".stl") {
    check_stl(file);
  } else {
    list_mesh_file(file);
  }
  const LibraryMesh library = ask_library(file);
  if (!library.triangles.empty()) return triangles_of(file, library, scale);
  if (library.tetrahedra.empty()) refuse(file, "it has no triangles");
  return drop_unused_nodes(boundary_of(load_tet_mesh(file, scale)));
}

void write_tet_mesh(const TetMesh& mesh, const path& file, MshFormat format) {
  const std::string extension = file.extension().string();
  if (extension != ".msh" && extension != ".vtk") refuse(file, "a mesh is written to .msh and .vtk files");
  if (mesh.tetrahedra.empty()) refuse(file, "the mesh to write has no tetrahedra");
  std::filesystem::remove(file);
  try {
    write_with_library(mesh, file, format.version, format.binary);
  } catch (const std::runtime_error& error) {
    refuse(file, error.what());
  }
  if (!std::filesystem::exists(file)) refuse(file, "the file cannot be written");
}

void write_stl(const TriangleMesh& mesh, const path& file) {
  std::ofstream out(file, std::ios::binary);
  const auto write = [&](const void* data, std::streamsize size) {
    out.write(static_cast<const char*>(data), size);
  };
  const auto write_vector = [&](const Eigen::Vector3d& v) {
    const Eigen::Vector3f single = v.cast<float>();
    write(single.data(), sizeof single);
  };
  const char header[80] = "binary STL, metres";
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  const std::uint16_t attributes = 0;
  write(header, sizeof header);
  write(&count, sizeof count);
  for (const auto& [a, b, c] : mesh.triangles) {
    write_vector((mesh.nodes[b] - mesh.nodes[a]).cross(mesh.nodes[c] - mesh.nodes[a]).normalized());
    for (int n : {a, b, c}) write_vector(mesh.nodes[n]);
    write(&attributes, sizeof attributes);
  }
  if (!out.flush()) refuse(file, "the file cannot be written");
}

TetMesh fill_surface(const TriangleMesh& surface, double size) {
  return fill_with_library(surface, size);
}

}  // namespace palpate
