// How much of a sphere's squares lies over tissue, where that ends below them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/contact/patch/patch.hpp"
#include "common/geometry/piece_within.hpp"

namespace palpate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kWhole = 1 - 1e-9;  // of a square: what is missing is rounding
constexpr double kFaces = 0.4;       // cosine between a facet's normal and the patch's, from which it counts in full
// Of a square's own compliance; with 1, faces at angles bend a column by a quarter too much.
constexpr double kAside = 10;
constexpr double kLeastSunk = 0.1;  // of the radius: so deep at least a sphere is looked at
constexpr double kMostPast = 0.5;   // of a sphere, past the tissue: from here on it does not give way aside

std::array<Vector2d, 3> flattened(const std::array<Vector3d, 3>& t) {
  return {t[0].head<2>(), t[1].head<2>(), t[2].head<2>()};
}

// Whether a line comes into a square.
bool enters(const Vector2d& from, const Vector2d& to, const Vector2d& middle, double half) {
  const Vector2d a = from - middle, b = to - middle, along = b - a;
  if (std::min(a.x(), b.x()) > half || std::max(a.x(), b.x()) < -half) return false;
  if (std::min(a.y(), b.y()) > half || std::max(a.y(), b.y()) < -half) return false;
  return std::abs(a.x() * b.y() - a.y() * b.x()) <= half * along.lpNorm<1>();
}

}  // namespace

// A square that the rim goes through stands in the middle of what lies over tissue, and is as much as that. Facets that
// turn aside count less and less, so that none of them comes or goes at once.
bool Patch::lay_rims(const Ground& ground) {
  std::array<PlanePiece, kMaxCells> piece;
  std::array<int, kMaxCells> parted;
  const int count = find_parted(ground, parted);
  if (count == 0) return false;
  const double half = 0.5 * grid_.edge(), whole = grid_.edge() * grid_.edge();
  for (const int t : near_) {
    if (!may_lie_below(ground, t, grid_.edge())) continue;
    const std::array<Vector2d, 3> flat = flattened(seen_in_plane(ground, t));
    const double share = std::min((facing(ground, t) - kFacing) / (kFaces - kFacing), 1.0);
    const Vector2d low = flat[0].cwiseMin(flat[1]).cwiseMin(flat[2]),
                   high = flat[0].cwiseMax(flat[1]).cwiseMax(flat[2]);
    for (const int p : std::span(parted).first(count)) {
      const Vector2d& middle = grid_.middle(p);
      if ((low - middle).maxCoeff() < half && (middle - high).maxCoeff() < half)
        piece[p] += piece_within(flat, middle, half) * share;
    }
  }
  for (const int p : std::span(parted).first(count)) {
    if (piece[p].area >= kWhole * whole) continue;
    cells_[p].cover = piece[p].area / whole;
    if (piece[p].area > 0) foot_middle_[p] = piece[p].middle();
  }
  return true;
}

// Squares below which the tissue may end.
int Patch::find_parted(const Ground& ground, std::array<int, kMaxCells>& parted) const {
  std::array<bool, kMaxCells> is_parted{};
  for (const int t : near_) {
    if (!may_lie_below(ground, t, grid_.edge()) || ground.surface.faces_with_all_about(t, -normal_, kFaces)) continue;
    const std::array<Vector2d, 3> flat = flattened(seen_in_plane(ground, t));
    for (int v = 0; v < 3; ++v) {
      const int beyond = ground.surface.across(t, v);
      if (beyond >= 0 && !ground.surface.is_left_out(beyond) && facing(ground, beyond) >= kFaces) continue;
      for (int p = 0; p < grid_.size(); ++p)
        is_parted[p] |= enters(flat[v], flat[(v + 1) % 3], grid_.middle(p), 0.5 * grid_.edge());
    }
  }
  int count = 0;
  for (int p = 0; p < grid_.size(); ++p)
    if (is_parted[p]) parted[count++] = p;
  return count;
}

// [m/N] Within a face a sphere gives way to what pushes it aside: where the middle of its pressures lies is known less
// well than the normal, which is of the whole surface below. Over a rim, where it reaches past the tissue, it does not.
double Patch::give_aside() const {
  if (rows_.empty() || grid_.strip()) return 0;
  double deepest = -std::numeric_limits<double>::infinity();
  for (const Cell& cell : cells_) deepest = std::max(deepest, cell.gap);
  const double sunk = std::max(kLeastSunk * grid_.radius(), deepest), plane = grid_.radius() - sunk;
  double all = 0, met = 0;  // [m] by which its squares are below a plane that it is sunk in, and below the tissue
  for (int p = 0; p < grid_.size(); ++p) {
    const double below = std::max(grid_.rise(p) - plane, 0.0);
    all += below;
    met += cells_[p].cover * std::clamp(cells_[p].gap + sunk - deepest, 0.0, below);
  }
  const double s = std::max(1 - (1 - met / all) / kMostPast, 0.0);
  return kAside * kernel_.own() * s * s * (3 - 2 * s);
}

}  // namespace palpate
