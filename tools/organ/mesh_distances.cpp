#include "tools/organ/mesh_distances.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <optional>
#include <stdexcept>

#include "common/mesh/surface.hpp"
#include "tools/organ/finding.hpp"
#include "tools/organ/surface_library.hpp"

namespace palpate {
namespace {

constexpr double kEnoughOfGap = 0.5;

/// The outer surface, with its nodes alone.
TriangleMesh outer_surface(const TetMesh& mesh) {
  const Surface surface = extract_surface(mesh);
  std::vector<int> number(mesh.nodes.size(), -1);
  TriangleMesh outer;
  for (const int n : surface.nodes) {
    number[n] = static_cast<int>(outer.nodes.size());
    outer.nodes.push_back(mesh.nodes[n]);
  }
  for (const auto& [a, b, c] : surface.triangles) outer.triangles.push_back({number[a], number[b], number[c]});
  return outer;
}

struct MeasuredBody {
  explicit MeasuredBody(const NamedMesh& named) : name(named.name), surface(outer_surface(named.mesh)), tree(surface) {
    for (const Eigen::Vector3d& x : surface.nodes) box.extend(x);
  }

  std::string name;
  TriangleMesh surface;
  Eigen::AlignedBox3d box;
  SurfaceTree tree;
};

struct Nearest {
  double distance = std::numeric_limits<double>::infinity();  ///< [m]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();            ///< a node of one of them
  std::array<std::string, 2> names;
};

/// Of nodes of `a` to `b`, where that is less than what is known.
void note_nearer(const MeasuredBody& a, const MeasuredBody& b, Nearest& nearest) {
  for (const Eigen::Vector3d& x : a.surface.nodes) {
    if (b.box.exteriorDistance(x) >= nearest.distance) continue;
    const double first = (b.surface.nodes[0] - x).norm();
    const double distance = b.tree.distance(x, std::min(nearest.distance, first));
    if (distance < nearest.distance) nearest = {distance, x, {a.name, b.name}};
  }
}

/// A place where two bodies' surfaces cross, or where one lies in the other.
std::optional<Eigen::Vector3d> crossing_of(const MeasuredBody& a, const MeasuredBody& b) {
  if (!a.box.intersects(b.box)) return {};
  TriangleMesh both = a.surface;
  const int nodes = static_cast<int>(both.nodes.size()), triangles = static_cast<int>(both.triangles.size());
  both.nodes.insert(both.nodes.end(), b.surface.nodes.begin(), b.surface.nodes.end());
  for (const auto& [i, j, k] : b.surface.triangles) both.triangles.push_back({i + nodes, j + nodes, k + nodes});
  for (const auto& [first, second] : crossing_triangles(both)) {
    if (first >= triangles || second < triangles) continue;
    const auto& [i, j, k] = both.triangles[first];
    return (both.nodes[i] + both.nodes[j] + both.nodes[k]) / 3;
  }
  if (b.tree.winding(a.surface.nodes[0]) != 0) return a.surface.nodes[0];
  if (a.tree.winding(b.surface.nodes[0]) != 0) return b.surface.nodes[0];
  return {};
}

void tell_crossing(const MeasuredBody& a, const MeasuredBody& b, double gap, Output& out) {
  const auto place = crossing_of(a, b);
  if (!place) return;
  const std::string said =
      fmt::format("the meshes of '{}' and '{}' cross at {}: ask for shorter edges or a smaller --deviation{}", a.name,
                  b.name, place_in_mm(*place), gap > 0 ? ", or for a larger --gap" : "");
  if (gap > 0) throw std::runtime_error(said);
  out.warn(said);
}

void tell_nearest(const Nearest& nearest, double gap, Output& out) {
  out.say(fmt::format("  least distance between the meshes: {:.3g} mm, of '{}' and '{}' at {}", 1e3 * nearest.distance,
                      nearest.names[0], nearest.names[1], place_in_mm(nearest.place)));
  out.figures()["least_distance"] = {
      {"distance_m", nearest.distance}, {"between", nearest.names}, {"at_m", nearest.place}};
  if (nearest.distance < kEnoughOfGap * gap)
    out.warn(
        fmt::format("'{}' and '{}' come as near as {:.3g} mm at {}, less than half the gap of {:.3g} mm: ask for "
                    "shorter edges or a smaller --deviation",
                    nearest.names[0], nearest.names[1], 1e3 * nearest.distance, place_in_mm(nearest.place), 1e3 * gap));
}

}  // namespace

void tell_distances(const std::vector<NamedMesh>& meshes, double gap, Output& out) {
  if (meshes.size() < 2) return;
  std::vector<MeasuredBody> bodies;
  for (const NamedMesh& named : meshes) bodies.emplace_back(named);
  Nearest nearest;
  for (auto a = bodies.begin(); a != bodies.end(); ++a)
    for (auto b = a + 1; b != bodies.end(); ++b) {
      tell_crossing(*a, *b, gap, out);
      if (a->box.exteriorDistance(b->box) >= nearest.distance) continue;
      note_nearer(*a, *b, nearest);
      note_nearer(*b, *a, nearest);
    }
  tell_nearest(nearest, gap, out);
}

}  // namespace palpate
