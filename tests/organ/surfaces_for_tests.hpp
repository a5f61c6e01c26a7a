#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "common/mesh/tet_mesh.hpp"

namespace palpate::testing {

/// Returns where it was written.
inline std::filesystem::path write_file(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

/// A sphere of `rings` rings of 2 `rings` nodes, and its poles; normals outward.
inline TriangleMesh make_sphere(const Eigen::Vector3d& middle, double radius, int rings) {
  TriangleMesh mesh;
  const int around = 2 * rings;
  mesh.nodes.push_back(middle + radius * Eigen::Vector3d::UnitZ());
  for (int r = 1; r <= rings; ++r)
    for (int a = 0; a < around; ++a) {
      const double polar = r * std::numbers::pi / (rings + 1), angle = 2 * std::numbers::pi * a / around;
      mesh.nodes.push_back(middle + radius * Eigen::Vector3d(std::sin(polar) * std::cos(angle),
                                                             std::sin(polar) * std::sin(angle), std::cos(polar)));
    }
  mesh.nodes.push_back(middle - radius * Eigen::Vector3d::UnitZ());
  const int last = static_cast<int>(mesh.nodes.size()) - 1;
  const auto node = [&](int r, int a) { return 1 + (r - 1) * around + a % around; };
  for (int a = 0; a < around; ++a) {
    mesh.triangles.push_back({0, node(1, a), node(1, a + 1)});
    for (int r = 1; r < rings; ++r) {
      mesh.triangles.push_back({node(r, a), node(r + 1, a), node(r + 1, a + 1)});
      mesh.triangles.push_back({node(r, a), node(r + 1, a + 1), node(r, a + 1)});
    }
    mesh.triangles.push_back({last, node(rings, a + 1), node(rings, a)});
  }
  return mesh;
}

inline void append(TriangleMesh& mesh, const TriangleMesh& more) {
  const int shift = static_cast<int>(mesh.nodes.size());
  mesh.nodes.insert(mesh.nodes.end(), more.nodes.begin(), more.nodes.end());
  for (const auto& [a, b, c] : more.triangles) mesh.triangles.push_back({a + shift, b + shift, c + shift});
}

/// The surface of cubes of edge 1 that stand where `is_there` says, in [0, size) along each axis; normals outward.
template <class IsThere>
TriangleMesh make_cubes(int size, const IsThere& is_there) {
  TriangleMesh mesh;
  const int along = size + 1;
  for (int n = 0; n < along * along * along; ++n)
    mesh.nodes.emplace_back(n % along, n / along % along, n / (along * along));
  const auto filled = [&](const Eigen::Vector3i& c) {
    return (c.array() >= 0).all() && (c.array() < size).all() && is_there(c.x(), c.y(), c.z());
  };
  const auto node = [&](const Eigen::Vector3i& c) { return c.x() + along * (c.y() + along * c.z()); };
  for (int n = 0; n < size * size * size; ++n) {
    const Eigen::Vector3i cube(n % size, n / size % size, n / (size * size));
    if (!filled(cube)) continue;
    for (int side = 0; side < 6; ++side) {
      const int axis = side / 2, up = side % 2;
      const Eigen::Vector3i way = Eigen::Vector3i::Unit(axis), u = Eigen::Vector3i::Unit((axis + 1) % 3),
                            v = Eigen::Vector3i::Unit((axis + 2) % 3), at = cube + up * way;
      if (filled(cube + (2 * up - 1) * way)) continue;
      const int a = node(at), b = node(at + u), c = node(at + u + v), d = node(at + v);
      mesh.triangles.push_back(up ? std::array{a, b, c} : std::array{a, c, b});
      mesh.triangles.push_back(up ? std::array{a, c, d} : std::array{a, d, c});
    }
  }
  return mesh;
}

inline std::string text_stl(const TriangleMesh& mesh) {
  std::string text = "solid liver of a facet\n";
  const auto place = [&](int n) {
    const Eigen::Vector3d& x = mesh.nodes[n];
    return std::to_string(x.x()) + " " + std::to_string(x.y()) + " " + std::to_string(x.z());
  };
  for (const auto& t : mesh.triangles) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const int n : t) text += "  vertex " + place(n) + "\n";
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid liver of a facet\n";
}

/// `first`: how the header begins; `told`: triangles that it announces.
inline std::string binary_stl(const TriangleMesh& mesh, const std::string& first, std::uint32_t told) {
  std::string bytes = first;
  bytes.resize(80, ' ');
  bytes.append(reinterpret_cast<const char*>(&told), 4);
  for (const auto& t : mesh.triangles) {
    bytes.append(12, '\0');
    for (const int n : t) {
      const Eigen::Vector3f x = mesh.nodes[n].cast<float>();
      bytes.append(reinterpret_cast<const char*>(x.data()), 12);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

}  // namespace palpate::testing
