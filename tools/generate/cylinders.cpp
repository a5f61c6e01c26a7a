#include "tools/generate/cylinders.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/mesh/generators.hpp"
#include "common/mesh/quality.hpp"
#include "tools/generate/flips.hpp"

namespace palpate {
namespace {

constexpr double kRadius = 0.015, kHeight = 0.05;  // [m]
constexpr int kInner = 12, kOuter = 18, kLevels = 8;
constexpr int kPerLevel = 1 + kInner + kOuter;
constexpr double kInnerShare = 0.54;  // of the radius, where the triangles of the disc are most even

/// Corners of the disc's 42 triangles, ascending, so that the prisms above two neighbours split their common
/// side alike.
std::vector<std::array<int, 3>> disc_triangles() {
  std::vector<std::array<int, 3>> triangles;
  const auto inner = [](int j) { return 1 + j % kInner; };
  const auto outer = [](int j) { return 1 + kInner + j % kOuter; };
  for (int j = 0; j < kInner; ++j) triangles.push_back({0, inner(j), inner(j + 1)});
  for (int i = 0, o = 0; i < kInner || o < kOuter;) {  // round the two rings, the one that lags behind first
    const bool outwards = (o + 0.5) * kInner < (i + 0.5) * kOuter;
    triangles.push_back(outwards ? std::array{inner(i), outer(o), outer(o + 1)}
                                 : std::array{inner(i), inner(i + 1), outer(o)});
    ++(outwards ? o : i);
  }
  for (auto& t : triangles) std::sort(t.begin(), t.end());
  return triangles;
}

void add(TetMesh& mesh, std::array<int, 4> tet) {
  if (tet_volume(mesh, tet) < 0) std::swap(tet[2], tet[3]);
  mesh.tetrahedra.push_back(tet);
}

void add_ring(TetMesh& mesh, int count, double radius, double z) {
  for (int j = 0; j < count; ++j) {
    const double angle = 2 * std::numbers::pi * j / count;
    mesh.nodes.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
}

// Keeps the file short and the same on every machine.
void round_to_nanometres(TetMesh& mesh) {
  for (Eigen::Vector3d& x : mesh.nodes) x = (x * 1e9).array().round() / 1e9;
}

}  // namespace

TetMesh make_cylinder_tear() {
  TetMesh mesh;
  for (int level = 0; level < kLevels; ++level) {
    const double z = kHeight * level / (kLevels - 1);
    mesh.nodes.emplace_back(0, 0, z);
    add_ring(mesh, kInner, kInnerShare * kRadius, z);
    add_ring(mesh, kOuter, kRadius, z);
  }
  round_to_nanometres(mesh);
  for (int n = 0; n < kLevels * kPerLevel; ++n) {
    if (n < kPerLevel) mesh.groups["bottom"].nodes.push_back(n);
    if (n >= (kLevels - 1) * kPerLevel) mesh.groups["top"].nodes.push_back(n);
    if (n % kPerLevel > kInner) mesh.groups["side"].nodes.push_back(n);
  }
  for (int level = 0; level + 1 < kLevels; ++level) {
    for (const auto& t : disc_triangles()) {
      std::array<int, 3> a, b;
      for (int c = 0; c < 3; ++c) {
        a[c] = level * kPerLevel + t[c];
        b[c] = a[c] + kPerLevel;
      }
      if (level % 2) std::swap(a, b);  // every other layer is a mirror image
      add(mesh, {a[0], a[1], a[2], b[2]});
      add(mesh, {a[0], a[1], b[1], b[2]});
      add(mesh, {a[0], b[0], b[1], b[2]});
    }
  }
  flip_faces(mesh, 7);
  return mesh;
}

TetMesh make_cylinder_hybrid() {
  TetMesh mesh = make_cylinder(kRadius, kHeight, 4, 12);
  round_to_nanometres(mesh);
  for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t) {
    double height = 0;
    for (int n : mesh.tetrahedra[t]) height += mesh.nodes[n].z() / 4;
    MeshGroup& half = mesh.groups[height < kHeight / 2 ? "lower" : "upper"];
    half.tetrahedra.push_back(t);
    half.nodes.insert(half.nodes.end(), mesh.tetrahedra[t].begin(), mesh.tetrahedra[t].end());
  }
  for (const char* name : {"lower", "upper"}) {
    std::vector<int>& nodes = mesh.groups[name].nodes;
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
  return mesh;
}

}  // namespace palpate
