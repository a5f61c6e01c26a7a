#include "common/mesh/mesh_file.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <unordered_map>

#include "common/mesh/fill.hpp"
#include "common/mesh/gmsh_library.hpp"
#include "common/mesh/library_agreement.hpp"
#include "common/mesh/listing.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

using std::filesystem::path;

void take_elements(const path& file, const FileListing& listing, TetMesh& mesh) {
  for (const ListedElement& element : listing.elements) {
    if (element.type == 4) {
      mesh.tetrahedra.push_back({element.nodes[0], element.nodes[1], element.nodes[2], element.nodes[3]});
    } else if (element_dimension(element.type) == 3) {
      refuse_mesh(file, fmt::format("it has solid elements of {} nodes; only tetrahedra of 4 nodes are computed with",
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
      if (place == position.end()) refuse_mesh(file, fmt::format("triangle {}: one of its nodes does not exist", i));
      triangle[c] = place->second;
      if (!mesh.nodes[triangle[c]].allFinite()) {
        refuse_mesh(file, fmt::format("triangle {}: a coordinate is not a finite number", i));
      }
    }
    mesh.triangles.push_back(triangle);
  }
  return drop_unused_nodes(mesh);
}

}  // namespace

TetMesh load_tet_mesh(const path& file, double scale) {
  check_mesh_format(file, false);
  check_mesh_scale(file, scale);
  const FileListing listing = list_mesh_file(file);
  TetMesh mesh;
  for (const auto& x : listing.nodes) mesh.nodes.push_back(scale * x);
  take_elements(file, listing, mesh);
  if (mesh.tetrahedra.empty())
    refuse_mesh(file, std::string("the mesh has no tetrahedra; where it is a surface, ") + kMakesMesh);
  const LibraryMesh library = ask_library(file);
  check_agreement(file, listing, mesh.tetrahedra, library, library.tetrahedra);
  turn_if_all_negative(mesh);
  check_tet_mesh(mesh, file.string());
  mesh.groups = named_groups(listing, library);
  return mesh;
}

TriangleMesh load_triangle_mesh(const path& file, double scale) {
  check_mesh_format(file, true);
  check_mesh_scale(file, scale);
  if (file.extension() != ".stl") list_mesh_file(file);
  const LibraryMesh library = ask_library(file);
  if (!library.triangles.empty()) return triangles_of(file, library, scale);
  if (library.tetrahedra.empty()) refuse_mesh(file, "it has no triangles");
  return drop_unused_nodes(boundary_of(load_tet_mesh(file, scale)));
}

void write_tet_mesh(const TetMesh& mesh, const path& file, MshFormat format) {
  const std::string extension = file.extension().string();
  if (extension != ".msh" && extension != ".vtk") refuse_mesh(file, "a mesh is written to .msh and .vtk files");
  if (mesh.tetrahedra.empty()) refuse_mesh(file, "the mesh to write has no tetrahedra");
  std::filesystem::remove(file);
  try {
    write_with_library(mesh, file, format.version, format.binary);
  } catch (const std::runtime_error& error) {
    refuse_mesh(file, error.what());
  }
  if (!std::filesystem::exists(file)) refuse_mesh(file, "the file cannot be written");
}

void write_stl(const TriangleMesh& mesh, const path& file) {
  std::ofstream out(file, std::ios::binary);
  const auto write = [&](const void* data, std::streamsize size) { out.write(static_cast<const char*>(data), size); };
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
  if (!out.flush()) refuse_mesh(file, "the file cannot be written");
}

TetMesh fill_surface(const TriangleMesh& surface, double size) {
  return fill_with_library(surface, size);
}

}  // namespace palpate
