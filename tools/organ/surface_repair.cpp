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

#include "tools/organ/surface_library.hpp"
#include "tools/organ/surface_shells.hpp"

namespace palpate {
namespace {

constexpr double kSamePlace = 1e-7;  // of the diagonal: corners that near are one
constexpr double kNoArea = 1e-12;    // of the longest edge squared

using Triangle = std::array<int, 3>;

std::string place_of(const TriangleMesh& mesh, const Triangle& t) {
  return place_in_mm((mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]]) / 3);
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

TriangleMesh join_corners(const TriangleMesh& mesh, double near) {
  TriangleMesh joined;
  Places places(near);
  std::vector<int> number;
  for (const Eigen::Vector3d& x : mesh.nodes) number.push_back(places.number_of(x, joined.nodes));
  for (const Triangle& t : mesh.triangles) joined.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  return joined;
}

/// Takes triangles away that `which` says, and notes how many and where the first is.
template <class Which>
void take_away(TriangleMesh& mesh, const char* what, std::vector<std::string>& findings, const Which& which) {
  std::vector<Triangle> kept;
  std::size_t first = 0, count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!which(mesh.triangles[t]))
      kept.push_back(mesh.triangles[t]);
    else if (count++ == 0)
      first = t;
  }
  if (count > 0)
    findings.push_back(
        fmt::format("{} triangles {}, the first at {}: left out", count, what, place_of(mesh, mesh.triangles[first])));
  mesh.triangles = kept;
}

void take_repeated_away(TriangleMesh& mesh, std::vector<std::string>& findings) {
  take_away(mesh, "without area", findings,
            [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  std::set<Triangle> known;
  take_away(mesh, "that are there twice", findings, [&](Triangle t) {
    std::ranges::sort(t);
    return !known.insert(t).second;
  });
}

/// What cannot be taken away without a gap: it bounds nothing and stays.
void note_needles(const TriangleMesh& mesh, std::vector<std::string>& findings) {
  std::size_t count = 0;
  const Triangle* first = nullptr;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.nodes[t[1]] - mesh.nodes[t[0]], b = mesh.nodes[t[2]] - mesh.nodes[t[0]];
    const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (a - b).squaredNorm()});
    if (a.cross(b).norm() > kNoArea * longest) continue;
    if (count++ == 0) first = &t;
  }
  if (count > 0)
    findings.push_back(fmt::format("{} triangles whose corners lie on a line, the first at {}: they bound nothing",
                                   count, place_of(mesh, *first)));
}

void note_crowded_edges(const TriangleMesh& mesh, std::vector<std::string>& findings) {
  std::map<std::array<int, 2>, int> around;
  for (const Triangle& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) ++around[{std::min(t[c], t[(c + 1) % 3]), std::max(t[c], t[(c + 1) % 3])}];
  std::size_t count = 0;
  std::array<int, 2> first{};
  for (const auto& [edge, triangles] : around)
    if (triangles > 2 && count++ == 0) first = edge;
  if (count > 0)
    findings.push_back(fmt::format("{} edges that more than two triangles share, the first at {}: parted there", count,
                                   place_in_mm(0.5 * (mesh.nodes[first[0]] + mesh.nodes[first[1]]))));
}

/// Turned triangles are the fewer ones of each shell.
void orient(TriangleMesh& mesh, std::vector<std::string>& findings) {
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
  std::size_t turned = 0, first = 0;
  for (const std::vector<int>& shell : shells_of(mesh)) {
    std::vector<int> of_shell;
    for (const int t : shell)
      if (is_turned(t)) of_shell.push_back(t);
    if (2 * of_shell.size() > shell.size()) {  // the others were
      std::vector<int> others;
      std::ranges::set_difference(shell, of_shell, std::back_inserter(others));
      of_shell = others;
    }
    if (!of_shell.empty() && turned == 0) first = of_shell.front();
    turned += of_shell.size();
  }
  if (turned > 0)
    findings.push_back(fmt::format("{} triangles turned against their neighbours, the first at {}: turned", turned,
                                   place_of(mesh, mesh.triangles[first])));
  if (mesh.nodes.size() > known.size())
    findings.push_back(fmt::format("{} nodes where the surface is not manifold, the first at {}: parted there",
                                   mesh.nodes.size() - known.size(), place_in_mm(mesh.nodes[known.size()])));
}

void close_holes(TriangleMesh& mesh, double largest_hole, std::vector<std::string>& findings) {
  for (const std::vector<int>& rim : rims_of(mesh)) {
    std::vector<Eigen::Vector3d> loop;
    Eigen::Vector3d low = mesh.nodes[rim[0]], high = low;
    for (const int n : rim) {
      loop.push_back(mesh.nodes[n]);
      low = low.cwiseMin(mesh.nodes[n]), high = high.cwiseMax(mesh.nodes[n]);
    }
    const double across = (high - low).norm();
    const std::string what = fmt::format("a hole of {:.3g} mm across with {} edges at {}", 1e3 * across, rim.size(),
                                         place_in_mm(0.5 * (low + high)));
    if (across > largest_hole)
      throw std::runtime_error(
          fmt::format("{}, larger than {:.3g} mm: close it in the program that the surface comes "
                      "from, or allow it by --hole",
                      what, 1e3 * largest_hole));
    const auto patch = close_loop(loop);
    if (patch.empty()) throw std::runtime_error(what + " that cannot be closed");
    for (const Triangle& t : patch) mesh.triangles.push_back({rim[t[0]], rim[t[1]], rim[t[2]]});
    findings.push_back(what + ": closed");
  }
}

/// Whether there are any.
bool note_crossings(const TriangleMesh& mesh, std::vector<std::string>& findings) {
  const auto pairs = crossing_triangles(mesh);
  if (pairs.empty()) return false;
  findings.push_back(
      fmt::format("{} pairs of triangles cross one another, the first at {}: the body is all that the "
                  "surface goes round",
                  pairs.size(), place_of(mesh, mesh.triangles[pairs[0].first])));
  return true;
}

}  // namespace

RepairedSurface repair_surface(TriangleMesh mesh, double largest_hole) {
  RepairedSurface repaired;
  std::vector<std::string>& findings = repaired.findings;
  mesh = join_corners(mesh, kSamePlace * diagonal(mesh));
  take_repeated_away(mesh, findings);
  if (mesh.triangles.empty()) throw std::runtime_error("no triangle has an area");
  note_needles(mesh, findings);
  note_crowded_edges(mesh, findings);
  orient(mesh, findings);
  leave_open_shells_out(mesh, largest_hole, findings);
  close_holes(mesh, largest_hole, findings);
  keep_largest_shell(mesh, findings);
  repaired.crosses_itself = note_crossings(mesh, findings);
  repaired.mesh = std::move(mesh);
  return repaired;
}

}  // namespace palpate
