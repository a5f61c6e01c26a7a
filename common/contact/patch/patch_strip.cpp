// How a patch is laid along a segment.
#include <algorithm>
#include <cmath>

#include "common/contact/patch/patch.hpp"
#include "common/contact/patch/surface_place.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kMinLevel = 0.2;  // cosine between the axis and the surface, below which its flank does not press
constexpr int kTurnsOn = 2;        // of the normal within a step once it is known
constexpr double kWindow = 1.5;    // half a window, over that of an even overlap with the same moments
constexpr double kBeside = 0.25;   // radii above the surface from which a cell is not there
constexpr double kMaxDepth = 10;   // radii below the surface, likewise
constexpr double kLines[] = {0, -0.35, 0.35, -0.65, 0.65, -0.85, 0.85};  // radii aside, along which it overlaps
constexpr double kHair = 1e-9;  // radii, by which what rounding may have moved is looked at all the same

/// By the line at `y` along the first axis; false if it does not meet the triangle. The ends go along the axis.
bool cut_at(const std::array<Vector3d, 3>& t, double y, TriangleCut& cut) {
  int count = 0;
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    const double ya = t[a].y() - y, yb = t[b].y() - y;
    if ((ya < 0) == (yb < 0) || count == 2) continue;
    const double share = ya / (ya - yb);
    cut.end[count] = (1 - share) * t[a] + share * t[b];
    cut.weights[count].setZero();
    cut.weights[count][a] = 1 - share;
    cut.weights[count++][b] = share;
  }
  if (count < 2) return false;
  if (cut.end[0].x() > cut.end[1].x()) {
    std::swap(cut.end[0], cut.end[1]);
    std::swap(cut.weights[0], cut.weights[1]);
  }
  return true;
}

/// Whether the line at `y` meets it, as in cut_at().
bool reaches(double low, double high, double y) {
  return low < y && high >= y;
}

/// The piece of a cut between two places along the axis; false if there is none.
bool clip(TriangleCut& cut, double from, double to) {
  const double low = cut.end[0].x(), length = cut.end[1].x() - low;
  const double begin = std::max(from, low), end = std::min(to, low + length);
  if (!(end > begin)) return false;
  const TriangleCut whole = cut;
  for (const int e : {0, 1}) {
    const double share = ((e == 0 ? begin : end) - low) / length;
    cut.end[e] = (1 - share) * whole.end[0] + share * whole.end[1];
    cut.weights[e] = (1 - share) * whole.weights[0] + share * whole.weights[1];
  }
  return true;
}

}  // namespace

// The normal is the mean over all of the surface that the axis' underside has passed, by how far it has.
bool Patch::find_along(const Ground& ground, const Segment& axis) {
  if (!touches() && !find_nearest(ground, axis)) return false;
  Overlap found;
  const int turns = touches() ? kTurnsOn : kTurns;
  for (int turn = 0; turn < turns; ++turn) {
    if (!turn_along(axis)) return false;
    found = overlap(ground);
    if (!(found.sum > 0)) return false;
    const Vector3d next = -found.normal.normalized();
    const bool done = (next - normal_).squaredNorm() < 1e-16;
    normal_ = next;
    if (done) break;
  }
  if (!turn_along(axis)) return false;
  lay_window(found);
  return true;
}

bool Patch::find_nearest(const Ground& ground, const Segment& axis) {
  double least = std::pow(grid_.radius() + above_, 2);
  bool found = false;
  for (const int t : near_) {
    if (!ground.surface.touchable(t)) continue;
    const ClosestOfTriangle p = closest_points(axis, ground.surface.corners(t));
    if (p.squared_distance >= least) continue;
    least = p.squared_distance;
    normal_ = -ground.surface.normal(t, p.weights);
    found = true;
  }
  return found;
}

// The first axis lies below the segment's. Of its ends, what a sphere there would reach is not the flank's.
bool Patch::turn_along(const Segment& axis) {
  const Vector3d along = (axis.end - axis.start) / grid_.length();
  const double down = along.dot(normal_);
  const double level = std::sqrt(std::max(0.0, 1 - down * down));
  if (level < kMinLevel) return false;
  across_ = (along - down * normal_) / level;
  up_ = normal_.cross(across_);
  const double ends = grid_.radius() * down;
  flank_ = {.slope = down / level,
            .steep = 1 / level,
            .from = std::max(0.0, -ends),
            .to = grid_.length() * level - std::max(0.0, ends)};
  return flank_.to > flank_.from;
}

// Over lines along the axis' underside, spread across the strip.
Patch::Overlap Patch::overlap(const Ground& ground) const {
  Overlap all;
  const double radius = grid_.radius(), hair = kHair * radius;
  // Before or behind all of the lines, or below them.
  const auto is_aside = [&](const std::array<Vector3d, 3>& t) {
    const auto [low, high] = std::minmax({t[0].x(), t[1].x(), t[2].x()});
    const auto over = [&](const Vector3d& p) { return flank_.slope * p.x() - p.z(); };
    const double gap = std::max({over(t[0]), over(t[1]), over(t[2])}) + radius * flank_.steep + above_;
    return high < flank_.from - hair || low > flank_.to + hair || gap < -hair;
  };
  for (const int t : near_) {
    if (!presses(ground, t)) continue;
    const Triangle c = ground.surface.corners(t);
    const double side = up_.dot(laid_at_), y0 = up_.dot(c[0]) - side, y1 = up_.dot(c[1]) - side,
                 y2 = up_.dot(c[2]) - side;
    if (std::min({y0, y1, y2}) > radius || std::max({y0, y1, y2}) < -radius) continue;
    const std::array<Vector3d, 3> flat{in_plane(c[0]), in_plane(c[1]), in_plane(c[2])};
    if (is_aside(flat)) continue;
    const auto [low, high] = std::minmax({flat[0].y(), flat[1].y(), flat[2].y()});
    for (const double share : kLines) {
      TriangleCut cut;
      if (reaches(low, high, share * radius) && cut_at(flat, share * radius, cut) && clip(cut, flank_.from, flank_.to))
        add_overlap(ground, t, radius * std::sqrt(1 - share * share) * flank_.steep + above_, cut, all);
    }
  }
  return all;
}

// `under` [m]: of the part's underside below its axis.
void Patch::add_overlap(const Ground& ground, int triangle, double under, TriangleCut cut, Overlap& all) const {
  const auto gap = [&](const Vector3d& p) { return flank_.slope * p.x() + under - p.z(); };
  const double g0 = gap(cut.end[0]), g1 = gap(cut.end[1]), x0 = cut.end[0].x(), dx = cut.end[1].x() - x0;
  if (g0 <= 0 && g1 <= 0) return;
  const double zero = x0 + g0 / (g0 - g1) * dx;
  if ((g0 < 0 || g1 < 0) && !clip(cut, g0 < 0 ? zero : x0, g1 < 0 ? zero : x0 + dx)) return;
  const double length = cut.end[1].x() - cut.end[0].x();
  double sum = 0;
  for (const double share : {0.0, 0.5, 1.0}) {  // Simpson
    const Vector3d p = (1 - share) * cut.end[0] + share * cut.end[1];
    const double part = (share == 0.5 ? 4 : 1) * length / 6 * std::max(gap(p), 0.0);
    sum += part;
    all.first += part * p.x();
    all.second += part * p.x() * p.x();
  }
  all.sum += sum;
  all.normal += sum * ground.surface.normal(triangle, 0.5 * (cut.weights[0] + cut.weights[1]));
}

void Patch::lay_window(const Overlap& o) {
  const double middle = o.first / o.sum, spread = std::sqrt(std::max(0.0, o.second / o.sum - middle * middle));
  const double half = kWindow * std::sqrt(3.0) * spread + 0.5 * grid_.radius();
  const double from = std::max(flank_.from, middle - half), to = std::min(flank_.to, middle + half);
  cell_length_ = std::max((to - from) / grid_.columns(), 1e-6 * grid_.radius());
  window_ = from;
  passed_ = middle;
}

void Patch::lay_anchor(const Ground& ground) {
  const Vector3d middle = laid_at_ + passed_ * (across_ + flank_.slope * normal_);
  const TrianglePoint below =
      highest_along(ground.surface, near_, middle, -normal_, 0).value_or(nearest_point(ground.surface, middle, near_));
  anchor_ = {ground.surface.map().triangles[below.triangle], below.weights};
}

void Patch::lay_strip(const Ground& ground) {
  kernel_.lay(cell_length_);
  for (Cell& cell : cells_) cell = {.gap = 0, .cover = 0};
  keep_below(ground);
  for (const int t : near_) {
    const std::array<Vector3d, 3> flat = seen_in_plane(ground, t);
    const auto [low, high] = std::minmax({flat[0].y(), flat[1].y(), flat[2].y()});
    for (int row = 0; row < grid_.rows(); ++row)
      if (reaches(low, high, grid_.across(row))) lay_row(row, flat);
  }
  bool any = false;
  for (int p = 0; p < grid_.size(); ++p) {
    Cell& cell = cells_[p];
    const double gap = cell.cover > kMinCover ? cell.gap / cell.cover : -std::numeric_limits<double>::infinity();
    const bool there = gap > -kBeside * grid_.radius() && gap < kMaxDepth * grid_.radius();
    const double x = cell_middle(grid_.column(p)), y = grid_.across(grid_.row(p));
    const double depth = flank_.slope * x + grid_.rise(p) * flank_.steep - gap;
    cell = {.gap = there ? gap : -std::numeric_limits<double>::infinity(),
            .cover = std::min(cell.cover, 1.0),
            .at = laid_at_ + x * across_ + y * up_ + (there ? depth : 0.0) * normal_};
    any |= there;
  }
  if (!any || near_.empty()) return;
  lay_anchor(ground);
  lay_middles();
  lay_feet(ground);
  for (int i = 0; i < grid_.feet(); ++i)
    if (!std::isfinite(feet_[i].depth) && (grid_.column_feet() || laid(i))) stand_on_nearest(ground, i);
  for (int p = 0; p < grid_.size(); ++p)
    if (!foot(p).stands()) cells_[p].gap = -std::numeric_limits<double>::infinity();
}

// Of the triangles that are near, those that the window lies over.
void Patch::keep_below(const Ground& ground) {
  const double end = window_ + grid_.columns() * cell_length_;
  const auto aside = [&](int t) {
    if (!presses(ground, t)) return true;
    const Triangle c = ground.surface.corners(t);
    Vector3d low = in_plane(c[0]), high = low;
    for (const int v : {1, 2}) {
      const Vector3d p = in_plane(c[v]);
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    return low.x() > end || high.x() < window_ || low.y() > grid_.radius() || high.y() < -grid_.radius();
  };
  near_ = near_.first(std::remove_if(near_.begin(), near_.end(), aside) - near_.begin());
}

// What a line through the cells of a row finds of a triangle below it: how much of each cell lies over it, and how deep
// that has come.
void Patch::lay_row(int row, const std::array<Vector3d, 3>& triangle) {
  TriangleCut cut;
  const double end = window_ + grid_.columns() * cell_length_;
  if (!cut_at(triangle, grid_.across(row), cut) || !clip(cut, window_, end)) return;
  const double from = cut.end[0].x(), to = cut.end[1].x();
  const double slope = (cut.end[1].z() - cut.end[0].z()) / (to - from);
  const int last = grid_.columns() - 1;
  const int first = std::clamp(static_cast<int>((from - window_) / cell_length_), 0, last);
  for (int column = first; column <= last; ++column) {
    const double begin = std::max(from, window_ + column * cell_length_);
    const double stop = std::min(to, window_ + (column + 1) * cell_length_);
    if (stop <= begin) break;
    const double middle = 0.5 * (begin + stop), share = (stop - begin) / cell_length_;
    const int p = column * grid_.rows() + row;
    const double under = flank_.slope * middle + grid_.rise(p) * flank_.steep;
    cells_[p].cover += share;
    cells_[p].gap += share * (under - (cut.end[0].z() + slope * (middle - from)));
  }
}

// Beyond the surface's edge.
void Patch::stand_on_nearest(const Ground& ground, int foot) {
  const double x = foot_middle_[foot].x();
  const Vector3d under = laid_at_ + x * across_ + foot_middle_[foot].y() * up_ +
                         (flank_.slope * x + grid_.radius() * flank_.steep) * normal_;
  const TrianglePoint nearest = nearest_point(ground.surface, under, near_);
  const Vector3d place = place_at(ground.surface, nearest.triangle, nearest.weights).point;
  feet_[foot] = {.triangle = nearest.triangle, .weights = nearest.weights, .depth = normal_.dot(place - laid_at_)};
  stand_on(ground.surface.map(), feet_[foot]);
}

}  // namespace palpate
