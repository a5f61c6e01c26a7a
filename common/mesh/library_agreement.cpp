#include "common/mesh/library_agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <unordered_map>

#include "common/files/ending.hpp"

namespace palpate {
namespace {

using std::filesystem::path;

std::string beginning_of(const path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text(16, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
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
    refuse_mesh(file, "the file ends before its last triangle");
  }
}

bool same(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  for (int i = 0; i < 3; ++i) {
    if (a[i] != b[i] && !(std::isnan(a[i]) && std::isnan(b[i]))) return false;
  }
  return true;
}

template <std::size_t N>
std::vector<std::array<int, N>> sorted_set(std::vector<std::array<int, N>> elements) {
  for (auto& e : elements) std::sort(e.begin(), e.end());
  std::sort(elements.begin(), elements.end());
  elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  return elements;
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

/// Whether `palpate mesh` reads it as a surface.
bool is_surface(const path& file) {
  constexpr std::array<const char*, 5> kSurfaces{".stl", ".obj", ".ply", ".off", ".vtp"};
  return std::ranges::any_of(kSurfaces, [&](const char* ending) { return has_ending(file, ending); });
}

}  // namespace

void refuse_mesh(const path& file, const std::string& reason) {
  throw std::runtime_error(fmt::format("{}: {}", file.string(), reason));
}

void check_mesh_format(const path& file, bool surfaces_too) {
  if (!std::filesystem::exists(file)) refuse_mesh(file, "the file does not exist");
  if (!std::filesystem::is_regular_file(file)) refuse_mesh(file, "this is not a file");
  const std::string extension = file.extension().string(), text = beginning_of(file);
  if (extension == ".msh") {
    const bool known = text.starts_with("$NOD") || text.starts_with("$MeshFormat");
    if (!known) refuse_mesh(file, "it does not begin as a Gmsh mesh does, with $MeshFormat or $NOD");
  } else if (extension == ".vtk") {
    if (!text.starts_with("# vtk DataFile"))
      refuse_mesh(file, "it does not begin as a legacy VTK file does, with # vtk DataFile");
  } else if (extension == ".stl" && surfaces_too) {
    check_stl(file);
  } else if (surfaces_too) {
    refuse_mesh(file, "a surface is read from .msh, .vtk and .stl files");
  } else {
    refuse_mesh(file, is_surface(file)
                          ? std::string("this is a surface, and a mesh of tetrahedra is asked for: ") + kMakesMesh
                          : "a mesh is read from .msh and .vtk files");
  }
}

void check_mesh_scale(const path& file, double scale) {
  if (!(std::isfinite(scale) && scale > 0))
    refuse_mesh(file, fmt::format("the scale {} is not a positive number", scale));
}

LibraryMesh ask_library(const path& file) {
  try {
    return read_with_library(file);
  } catch (const std::runtime_error& error) {
    refuse_mesh(file, error.what());
  }
}

template <std::size_t N>
void check_agreement(const path& file, const FileListing& listing, const std::vector<std::array<int, N>>& listed,
                     const LibraryMesh& library, const std::vector<std::array<std::uint64_t, N>>& read) {
  std::unordered_map<std::uint64_t, int> position;
  for (std::size_t i = 0; i < listing.node_numbers.size(); ++i) position[listing.node_numbers[i]] = static_cast<int>(i);
  bool agree = true;
  for (std::size_t i = 0; i < library.nodes.size() && agree; ++i) {
    const auto place = position.find(library.node_numbers[i]);
    agree = place != position.end() && same(listing.nodes[place->second], library.nodes[i]);
  }
  std::vector<std::array<int, N>> found(read.size());
  for (std::size_t t = 0; t < read.size() && agree; ++t) {
    for (std::size_t c = 0; c < N && agree; ++c) {
      const auto place = position.find(read[t][c]);
      agree = place != position.end();
      if (agree) found[t][c] = place->second;
    }
  }
  if (!agree || sorted_set(std::move(found)) != sorted_set(listed)) {
    refuse_mesh(file, "its lists can be read in two ways, the file is damaged");
  }
}

template void check_agreement<3>(const path&, const FileListing&, const std::vector<std::array<int, 3>>&,
                                 const LibraryMesh&, const std::vector<std::array<std::uint64_t, 3>>&);
template void check_agreement<4>(const path&, const FileListing&, const std::vector<std::array<int, 4>>&,
                                 const LibraryMesh&, const std::vector<std::array<std::uint64_t, 4>>&);

std::map<std::string, MeshGroup> named_groups(const FileListing& listing, const LibraryMesh& library) {
  static constexpr const char* kKinds[] = {"point", "curve", "surface", "volume"};
  const std::map<GroupKey, MeshGroup> groups = collect_groups(listing, library);
  std::map<int, int> dimensions_of_number;
  for (const auto& [key, group] : groups) ++dimensions_of_number[key.number];
  std::map<std::string, MeshGroup> named;
  for (const auto& [key, group] : groups) {
    const std::string number = std::to_string(key.number);
    const bool alone = dimensions_of_number[key.number] == 1;
    merge_into(named[alone ? number : fmt::format("{} {}", kKinds[key.dimension], number)], group);
  }
  for (const auto& [key, group] : groups) {
    const auto name = library.group_names.find({key.dimension, key.number});
    if (name != library.group_names.end() && name->second != std::to_string(key.number)) {
      merge_into(named[name->second], group);
    }
  }
  return named;
}

}  // namespace palpate
