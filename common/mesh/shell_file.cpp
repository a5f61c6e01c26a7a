#include "common/mesh/shell_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <stdexcept>
#include <unordered_map>

#include "common/mesh/library_agreement.hpp"
#include "common/mesh/shell_quality.hpp"

namespace palpate {
namespace {

using std::filesystem::path;

constexpr int kTriangle = 2, kPoint = 15;

void take_triangles(const path& file, const FileListing& listing, ShellMesh& mesh) {
  for (const ListedElement& element : listing.elements) {
    const int dimension = element_dimension(element.type);
    if (element.type == kTriangle) {
      mesh.triangles.push_back({element.nodes[0], element.nodes[1], element.nodes[2]});
    } else if (dimension >= 2) {
      refuse_mesh(file, fmt::format("it has {} elements of {} nodes; a shell is made of triangles of 3 nodes alone",
                                    dimension == 3 ? "solid" : "surface", element.nodes.size()));
    }
  }
}

/// Gmsh and VTK: nodes and numbers as the file lists them.
ShellMesh read_listed(const path& file) {
  const FileListing listing = list_mesh_file(file);
  ShellMesh mesh;
  mesh.nodes = listing.nodes;
  take_triangles(file, listing, mesh);
  const LibraryMesh library = ask_library(file);
  check_agreement(file, listing, mesh.triangles, library, library.triangles);
  mesh.groups = named_groups(listing, library);
  return mesh;
}

/// STL has corners, no nodes.
ShellMesh read_corners(const path& file) {
  const LibraryMesh library = ask_library(file);
  std::unordered_map<std::uint64_t, std::size_t> place;
  for (std::size_t i = 0; i < library.nodes.size(); ++i) place[library.node_numbers[i]] = i;
  std::map<std::array<double, 3>, int> number;
  ShellMesh mesh;
  for (const auto& corners : library.triangles) {
    std::array<int, 3> triangle;
    for (int c = 0; c < 3; ++c) {
      const auto found = place.find(corners[c]);
      if (found == place.end())
        refuse_mesh(file, fmt::format("triangle {}: one of its nodes does not exist", mesh.triangles.size()));
      const Eigen::Vector3d& x = library.nodes[found->second];
      if (!x.allFinite())
        refuse_mesh(file, fmt::format("triangle {}: a coordinate is not a finite number", mesh.triangles.size()));
      const auto [node, is_new] = number.emplace(std::array{x[0], x[1], x[2]}, static_cast<int>(mesh.nodes.size()));
      if (is_new) mesh.nodes.push_back(x);
      triangle[c] = node->second;
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace

ShellMesh load_shell_mesh(const path& file, double scale) {
  check_mesh_format(file, true);
  check_mesh_scale(file, scale);
  ShellMesh mesh = file.extension() == ".stl" ? read_corners(file) : read_listed(file);
  for (auto& x : mesh.nodes) x *= scale;
  orient_shell(mesh, file.string());
  check_shell_mesh(mesh, file.string());
  return mesh;
}

void write_shell_mesh(const ShellMesh& mesh, const path& file) {
  std::size_t points = 0;
  for (const auto& [name, group] : mesh.groups) points += group.nodes.size();
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  int number = 0;
  text += fmt::format("$PhysicalNames\n{}\n", mesh.groups.size());
  for (const auto& [name, group] : mesh.groups) text += fmt::format("0 {} \"{}\"\n", ++number, name);
  text += fmt::format("$EndPhysicalNames\n$Nodes\n{}\n", mesh.nodes.size());
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    text += fmt::format("{} {} {} {}\n", n + 1, mesh.nodes[n].x(), mesh.nodes[n].y(), mesh.nodes[n].z());
  text += fmt::format("$EndNodes\n$Elements\n{}\n", points + mesh.triangles.size());
  std::size_t element = 0;
  number = 0;
  for (const auto& [name, group] : mesh.groups) {
    ++number;
    for (int n : group.nodes) text += fmt::format("{} {} 2 {} {} {}\n", ++element, kPoint, number, n + 1, n + 1);
  }
  for (const auto& [a, b, c] : mesh.triangles)
    text += fmt::format("{} {} 2 0 1 {} {} {}\n", ++element, kTriangle, a + 1, b + 1, c + 1);
  text += "$EndElements\n";
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) refuse_mesh(file, "the file cannot be written");
}

}  // namespace palpate
