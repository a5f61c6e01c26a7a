#include "tools/organ/surface_repair.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <unordered_map>

#include "tools/organ/crowded_edges.hpp"
#include "tools/organ/surface_fault.hpp"
#include "tools/organ/surface_library.hpp"
#include "tools/organ/surface_shells.hpp"

namespace palpate {
namespace {

constexpr double kHole = 0.2;        // of the diagonal: so large a hole is closed
constexpr double kSamePlace = 1e-7;  // of the diagonal: corners that near are one,
constexpr double kSameEdge = 1e-3;   // unless it is more than that of the median edge
constexpr double kNoArea = 1e-12;    // of the longest edge squared

using Triangle = std::array<int, 3>;

Eigen::Vector3d place_of(const TriangleMesh& mesh, const Triangle& t) {
  return (mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]]) / 3;
}

struct Counted {
  const char *one, *many;
};

/// Many of one kind, if there are any: "3 triangles without area".
void note(const Counted& what, const char* done, std::vector<Eigen::Vector3d> places, std::vector<Finding>& findings) {
  const std::size_t count = places.size();
  if (count > 0)
    findings.push_back({fmt::format("{} {}", count, count == 1 ? what.one : what.many), done, std::move(places)});
}

/// Corners at one place, by the cells of a grid and their neighbours.
class Places {
 public:
  explicit Places(double near) : near_(near) {}

  int number_of(const Eigen::Vector3d& x, std::vector<Eigen::Vector3d>& places) {
    const Eigen::Array3d cell = (x / (2 * near_)).array();
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Array3d shift(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
      const auto found = in_cell_.find(key((cell - 0.5 + shift).floor()));
      if (found == in_cell_.end()) continue;
      for (const int n : found->second)
        if ((places[n] - x).norm() <= near_) return n;
    }
    places.push_back(x);
    in_cell_[key(cell.floor())].push_back(static_cast<int>(places.size()) - 1);
    return static_cast<int>(places.size()) - 1;
  }

 private:
  static std::uint64_t key(const Eigen::Array3d& cell) {
    std::uint64_t all = 0;
    for (int i = 0; i < 3; ++i)
      all = all * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(static_cast<long>(cell[i]));
    return all;
  }
  double near_;
  std::unordered_map<std::uint64_t, std::vector<int>> in_cell_;
};

/// A node or a few far away do not make the diagonal of a body.
double joined_distance(const TriangleMesh& mesh) {
  std::vector<double> edges;
  for (const Triangle& t : mesh.triangles)
    for (int c = 0; c < 3; ++c)
      if (const double edge = (mesh.nodes[t[c]] - mesh.nodes[t[(c + 1) % 3]]).norm(); edge > 0) edges.push_back(edge);
  const double near = kSamePlace * diagonal(mesh);
  if (edges.empty()) return near;
  const auto median = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2);
  std::ranges::nth_element(edges, median);
  return std::min(near, kSameEdge * *median);
}

void leave_unused_nodes_out(TriangleMesh& mesh, std::vector<Finding>& findings) {
  std::vector<int> number(mesh.nodes.size(), -1);
  for (const Triangle& t : mesh.triangles)
    for (const int n : t) number[n] = 0;
  std::vector<Eigen::Vector3d> used, places;
  for (std::size_t n = 0; n < number.size(); ++n) {
    const bool is_used = number[n] == 0;
    if (is_used) number[n] = static_cast<int>(used.size());
    (is_used ? used : places).push_back(mesh.nodes[n]);
  }
  for (Triangle& t : mesh.triangles)
    for (int& n : t) n = number[n];
  mesh.nodes = used;
  note({"node that no triangle uses", "nodes that no triangle uses"}, "left out", std::move(places), findings);
}

TriangleMesh join_corners(const TriangleMesh& mesh, double near) {
  TriangleMesh joined;
  Places places(near);
  std::vector<int> number;
  for (const Eigen::Vector3d& x : mesh.nodes) number.push_back(places.number_of(x, joined.nodes));
  for (const Triangle& t : mesh.triangles) joined.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  return joined;
}

/// Takes triangles away that `which` says, and notes them.
template <class Which>
void take_away(TriangleMesh& mesh, const Counted& what, std::vector<Finding>& findings, const Which& which) {
  std::vector<Triangle> kept;
  std::vector<Eigen::Vector3d> places;
  for (const Triangle& t : mesh.triangles)
    if (which(t))
      places.push_back(place_of(mesh, t));
    else
      kept.push_back(t);
  note(what, "left out", std::move(places), findings);
  mesh.triangles = kept;
}

void take_repeated_away(TriangleMesh& mesh, std::vector<Finding>& findings) {
  take_away(mesh, {"triangle without area", "triangles without area"}, findings,
            [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  std::set<Triangle> known;
  take_away(mesh, {"triangle that is there twice", "triangles that are there twice"}, findings, [&](Triangle t) {
    std::ranges::sort(t);
    return !known.insert(t).second;
  });
}

/// What cannot be taken away without a gap: it bounds nothing and stays.
void note_needles(const TriangleMesh& mesh, std::vector<Finding>& findings) {
  std::vector<Eigen::Vector3d> places;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.nodes[t[1]] - mesh.nodes[t[0]], b = mesh.nodes[t[2]] - mesh.nodes[t[0]];
    const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (a - b).squaredNorm()});
    if (a.cross(b).norm() <= kNoArea * longest) places.push_back(place_of(mesh, t));
  }
  note({"triangle whose corners lie on a line", "triangles whose corners lie on a line"}, "they bound nothing",
       std::move(places), findings);
}

void note_crowded_edges(const TriangleMesh& mesh, std::vector<Finding>& findings) {
  std::vector<std::array<int, 2>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) edges.push_back({std::min(t[c], t[(c + 1) % 3]), std::max(t[c], t[(c + 1) % 3])});
  std::ranges::sort(edges);
  std::vector<Eigen::Vector3d> places;
  for (auto edge = edges.begin(); edge != edges.end();) {
    const auto next = std::find_if(edge, edges.end(), [&](const auto& e) { return e != *edge; });
    if (next - edge > 2) places.push_back(0.5 * (mesh.nodes[(*edge)[0]] + mesh.nodes[(*edge)[1]]));
    edge = next;
  }
  note({"edge that more than two triangles share", "edges that more than two triangles share"}, "parted there",
       std::move(places), findings);
}

/// Turned triangles are the fewer ones of each shell: all come to lie as most of theirs did.
void orient(TriangleMesh& mesh, std::vector<Finding>& findings) {
  const std::vector<Triangle> before = mesh.triangles;
  const std::vector<Eigen::Vector3d> known = mesh.nodes;
  orient_triangles(mesh);
  const auto place = [&](int n) { return mesh.nodes[n]; };
  const auto is_turned = [&](std::size_t t) {
    const auto& [a, b, c] = before[t];
    const auto normal = [](const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& z) {
      return (y - x).cross(z - x).eval();
    };
    const Triangle& now = mesh.triangles[t];
    return normal(known[a], known[b], known[c]).dot(normal(place(now[0]), place(now[1]), place(now[2]))) < 0;
  };
  std::vector<Eigen::Vector3d> places;
  for (const std::vector<int>& shell : shells_of(mesh)) {
    std::vector<int> of_shell;
    for (const int t : shell)
      if (is_turned(t)) of_shell.push_back(t);
    if (2 * of_shell.size() > shell.size()) {  // the others were
      std::vector<int> others;
      std::ranges::set_difference(shell, of_shell, std::back_inserter(others));
      of_shell = others;
      for (const int t : shell) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    }
    for (const int t : of_shell) places.push_back(place_of(mesh, mesh.triangles[t]));
  }
  note({"triangle turned against its neighbours", "triangles turned against their neighbours"}, "turned",
       std::move(places), findings);
  note({"node where the surface is not manifold", "nodes where the surface is not manifold"}, "parted there",
       {mesh.nodes.begin() + static_cast<std::ptrdiff_t>(known.size()), mesh.nodes.end()}, findings);
}

/// Every hole is noted before one is refused.
void close_holes(TriangleMesh& mesh, double max_hole, std::vector<Finding>& findings) {
  std::string refusal;
  for (const std::vector<int>& rim : rims_of(mesh)) {
    std::vector<Eigen::Vector3d> loop;
    Eigen::Vector3d low = mesh.nodes[rim[0]], high = low;
    for (const int n : rim) {
      loop.push_back(mesh.nodes[n]);
      low = low.cwiseMin(mesh.nodes[n]), high = high.cwiseMax(mesh.nodes[n]);
    }
    const double size = across(mesh, rim);
    Finding hole{fmt::format("a hole of {:.3g} mm across with {} edges", 1e3 * size, rim.size()),
                 "",
                 {0.5 * (low + high)},
                 "holes"};
    std::string fault;
    if (size > max_hole)
      fault = fmt::format(
          "{}, larger than {:.3g} mm: close it in the program that the surface comes from, or allow it "
          "by --hole",
          say(hole), 1e3 * max_hole);
    const auto patch = fault.empty() ? close_loop(loop) : std::vector<Triangle>{};
    if (fault.empty() && patch.empty()) fault = say(hole) + " cannot be closed";
    for (const Triangle& t : patch) mesh.triangles.push_back({rim[t[0]], rim[t[1]], rim[t[2]]});
    hole.done = fault.empty() ? "closed" : "refused";
    findings.push_back(std::move(hole));
    if (refusal.empty()) refusal = fault;
  }
  if (!refusal.empty()) throw std::runtime_error(refusal);
}

std::vector<std::pair<int, int>> crossings_of(const TriangleMesh& mesh) try {
  return crossing_triangles(mesh);
} catch (const std::runtime_error&) {
  check_is_surface(mesh);  // with the place
  throw;
}

/// Whether there are any.
bool note_crossings(const TriangleMesh& mesh, std::vector<Finding>& findings) {
  std::vector<Eigen::Vector3d> places;
  for (const auto& [a, b] : crossings_of(mesh)) places.push_back(place_of(mesh, mesh.triangles[a]));
  note({"pair of triangles that cross one another", "pairs of triangles that cross one another"},
       "the body is all that the surface goes round", places, findings);
  return !places.empty();
}

}  // namespace

RepairedSurface repair_surface(TriangleMesh mesh, double max_hole, std::vector<Finding>& findings) {
  leave_unused_nodes_out(mesh, findings);
  mesh = join_corners(mesh, joined_distance(mesh));
  take_repeated_away(mesh, findings);
  if (mesh.triangles.empty()) throw std::runtime_error("no triangle has an area");
  note_needles(mesh, findings);
  note_crowded_edges(mesh, findings);
  part_crowded_edges(mesh);
  orient(mesh, findings);
  const double limit = max_hole > 0 ? max_hole : kHole * diagonal_of_largest_shell(mesh);
  leave_open_shells_out(mesh, limit, findings);
  close_holes(mesh, limit, findings);
  keep_largest_shell(mesh, findings);
  const bool crosses = note_crossings(mesh, findings);
  return {std::move(mesh), crosses};
}

}  // namespace palpate
