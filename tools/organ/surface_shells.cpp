#include "tools/organ/surface_shells.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "common/geometry/joined_sets.hpp"
#include "tools/organ/surface_library.hpp"

namespace palpate {
namespace {

using Triangle = std::array<int, 3>;

constexpr double kOnShell = 1e-7;  // of a shell's diagonal: what is that near to it lies on it

struct EdgeUse {
  std::array<int, 2> edge;  ///< ascending
  int triangle;
  bool forward;  ///< the triangle has the edge's nodes in this order
};

/// Those of one edge beside one another.
std::vector<EdgeUse> edge_uses(const TriangleMesh& mesh) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    for (int c = 0; c < 3; ++c) {
      const int a = mesh.triangles[t][c], b = mesh.triangles[t][(c + 1) % 3];
      uses.push_back({{std::min(a, b), std::max(a, b)}, t, a < b});
    }
  std::ranges::stable_sort(uses, {}, &EdgeUse::edge);
  return uses;
}

TriangleMesh part_of(const TriangleMesh& mesh, const std::vector<int>& shell) {
  TriangleMesh part;
  std::map<int, int> number;
  for (const int t : shell) {
    Triangle triangle = mesh.triangles[t];
    for (int& n : triangle) {
      const auto [place, is_new] = number.emplace(n, static_cast<int>(part.nodes.size()));
      if (is_new) part.nodes.push_back(mesh.nodes[n]);
      n = place->second;
    }
    part.triangles.push_back(triangle);
  }
  return part;
}

void turn(TriangleMesh& mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

/// Its normals outward, noted where they were not.
void turn_outward(TriangleMesh& shell, std::vector<Finding>& findings) {
  if (enclosed_volume(shell) >= 0) return;
  turn(shell);
  findings.push_back({fmt::format("a surface of {} triangles inside out", shell.triangles.size()),
                      "turned outward",
                      {shell.nodes[0]},
                      "surfaces inside out"});
}

void append(TriangleMesh& mesh, const TriangleMesh& more) {
  const int shift = static_cast<int>(mesh.nodes.size());
  mesh.nodes.insert(mesh.nodes.end(), more.nodes.begin(), more.nodes.end());
  for (const auto& [a, b, c] : more.triangles) mesh.triangles.push_back({a + shift, b + shift, c + shift});
}

double widest_hole(const TriangleMesh& mesh) {
  double widest = 0;
  for (const std::vector<int>& rim : rims_of(mesh)) widest = std::max(widest, across(mesh, rim));
  return widest;
}

std::vector<TriangleMesh> parts_of(const TriangleMesh& mesh) {
  std::vector<TriangleMesh> parts;
  for (const std::vector<int>& shell : shells_of(mesh)) parts.push_back(part_of(mesh, shell));
  return parts;
}

Finding shell_found(const char* what, const char* kind, const TriangleMesh& part, const char* done) {
  return {fmt::format("a {} of {} triangles and {:.3g} ml", what, part.triangles.size(),
                      1e6 * std::abs(enclosed_volume(part))),
          done,
          {part.nodes[0]},
          kind};
}

/// A closed shell that is asked what lies in it.
class Enclosure {
 public:
  explicit Enclosure(const TriangleMesh& shell) : tree_(shell), on_it_(kOnShell * diagonal(shell)) {
    for (const Eigen::Vector3d& x : shell.nodes) box_.extend(x);
  }

  /// Places of another shell; those on this one say nothing, since shells may touch.
  struct Sides {
    int inside = 0, outside = 0;
  };
  Sides sides_of(const TriangleMesh& part) const {
    Sides sides;
    for (const Eigen::Vector3d& x : part.nodes) add(x, sides);
    if (sides.inside + sides.outside > 0) return sides;
    for (const auto& [a, b, c] : part.triangles) add((part.nodes[a] + part.nodes[b] + part.nodes[c]) / 3, sides);
    return sides;
  }
  bool holds(const TriangleMesh& part) const {
    if (!std::ranges::all_of(part.nodes, [&](const auto& x) { return box_.exteriorDistance(x) <= on_it_; }))
      return false;
    const Sides sides = sides_of(part);
    return sides.inside > 0 && sides.outside == 0;
  }

 private:
  void add(const Eigen::Vector3d& x, Sides& sides) const {
    if (tree_.distance(x, 2 * on_it_) <= on_it_) return;
    ++(tree_.winding(x) != 0 ? sides.inside : sides.outside);
  }

  SurfaceTree tree_;
  Eigen::AlignedBox3d box_;
  double on_it_;  // [m]
};

/// Adds a closed shell to what is kept, or says why not. `inner`: those inside the largest, larger than this one.
void place_shell(TriangleMesh part, const Enclosure& largest, std::vector<Enclosure>& inner, TriangleMesh& kept,
                 std::vector<Finding>& findings) {
  const auto [inside, outside] = largest.sides_of(part);
  if (inside == 0) {
    findings.push_back(shell_found("stray shell", "stray shells", part, "left out"));
    return;
  }
  if (outside > 0) {
    findings.push_back(
        shell_found("shell that crosses the largest", "shells that cross the largest", part, "joined to it"));
    if (enclosed_volume(part) < 0) turn(part);
    append(kept, part);
    return;
  }
  const auto around = std::ranges::count_if(inner, [&](const Enclosure& shell) { return shell.holds(part); });
  inner.emplace_back(part);
  if (around > 0) {  // what is in a cavity hangs on nothing, and a hole in it goes with it
    findings.push_back(
        around % 2 == 1
            ? shell_found("loose island, a shell within a cavity,", "loose islands within cavities", part, "left out")
            : shell_found("cavity in a loose island", "cavities in loose islands", part, "left out with it"));
    return;
  }
  findings.push_back(shell_found("shell inside the largest", "shells inside the largest", part, "taken for a cavity"));
  if (enclosed_volume(part) > 0) turn(part);
  append(kept, part);
}

}  // namespace

double diagonal(const TriangleMesh& mesh) {
  Eigen::Vector3d low = mesh.nodes[mesh.triangles[0][0]], high = low;
  for (const Triangle& t : mesh.triangles)
    for (const int n : t) low = low.cwiseMin(mesh.nodes[n]), high = high.cwiseMax(mesh.nodes[n]);
  return (high - low).norm();
}

double diagonal_of_largest_shell(const TriangleMesh& mesh) {
  const std::vector<TriangleMesh> parts = parts_of(mesh);
  return diagonal(*std::ranges::max_element(parts, {}, surface_area));
}

std::vector<std::vector<int>> shells_of(const TriangleMesh& mesh) {
  JoinedSets sets(mesh.triangles.size());
  const std::vector<EdgeUse> uses = edge_uses(mesh);
  for (std::size_t i = 1; i < uses.size(); ++i)
    if (uses[i].edge == uses[i - 1].edge) sets.join(uses[i].triangle, uses[i - 1].triangle);
  std::map<int, std::vector<int>> shells;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) shells[sets.leader(t)].push_back(t);
  std::vector<std::vector<int>> all;
  for (auto& [first, shell] : shells) all.push_back(std::move(shell));
  return all;
}

std::vector<std::vector<int>> rims_of(const TriangleMesh& mesh) {
  std::map<int, std::set<int>> next;  // along rims: edges that triangles use more often one way than the other
  const std::vector<EdgeUse> uses = edge_uses(mesh);
  for (auto use = uses.begin(); use != uses.end();) {
    const auto [a, b] = use->edge;
    int forward = 0;
    for (; use != uses.end() && use->edge == std::array{a, b}; ++use) forward += use->forward ? 1 : -1;
    if (forward > 0) next[a].insert(b);
    if (forward < 0) next[b].insert(a);
  }
  std::vector<std::vector<int>> rims;
  for (auto& [start, ends] : next)
    while (!ends.empty()) {
      std::vector<int> rim;
      for (int n = start; !next[n].empty();) {
        const int to = *next[n].begin();
        next[n].erase(to);
        rim.push_back(n);
        n = to;
      }
      std::ranges::reverse(rim);
      rims.push_back(rim);
    }
  return rims;
}

double across(const TriangleMesh& mesh, const std::vector<int>& rim) {
  constexpr std::size_t kFew = 1000;
  constexpr int kGoes = 8;  // it seldom takes three
  double farthest = 0;
  if (rim.size() <= kFew) {
    for (const int a : rim)
      for (const int b : rim) farthest = std::max(farthest, (mesh.nodes[a] - mesh.nodes[b]).norm());
    return farthest;
  }
  Eigen::Vector3d from = mesh.nodes[rim[0]];
  for (int go = 0; go < kGoes; ++go) {
    const auto away = [&](int n) { return (mesh.nodes[n] - from).norm(); };
    const int end = *std::ranges::max_element(rim, {}, away);
    if (away(end) <= farthest) break;
    farthest = away(end);
    from = mesh.nodes[end];
  }
  return farthest;
}

double surface_area(const TriangleMesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    area += 0.5 * (mesh.nodes[b] - mesh.nodes[a]).cross(mesh.nodes[c] - mesh.nodes[a]).norm();
  return area;
}

double enclosed_volume(const TriangleMesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles) volume += mesh.nodes[a].dot(mesh.nodes[b].cross(mesh.nodes[c])) / 6;
  return volume;
}

void leave_open_shells_out(TriangleMesh& mesh, double max_hole, std::vector<Finding>& findings) {
  const std::vector<TriangleMesh> parts = parts_of(mesh);
  const auto largest = std::ranges::max_element(parts, {}, surface_area);
  TriangleMesh kept = *largest;
  for (auto part = parts.begin(); part != parts.end(); ++part) {
    if (part == largest) continue;
    if (widest_hole(*part) <= max_hole && part->triangles.size() > 1)
      append(kept, *part);
    else
      findings.push_back({fmt::format("an open sheet of {} triangle{}", part->triangles.size(),
                                      part->triangles.size() == 1 ? "" : "s"),
                          "left out",
                          {part->nodes[0]},
                          "open sheets"});
  }
  mesh = kept;
}

void keep_largest_shell(TriangleMesh& mesh, std::vector<Finding>& findings) {
  std::vector<TriangleMesh> parts = parts_of(mesh);
  std::ranges::stable_sort(parts, std::ranges::greater{}, [](const auto& p) { return std::abs(enclosed_volume(p)); });
  TriangleMesh kept = parts[0];
  turn_outward(kept, findings);
  const Enclosure largest(kept);
  std::vector<Enclosure> inner;
  for (std::size_t p = 1; p < parts.size(); ++p) place_shell(parts[p], largest, inner, kept, findings);
  mesh = kept;
}

}  // namespace palpate
