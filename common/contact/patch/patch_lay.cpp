// How a patch is laid on the surface under its sphere.
#include <algorithm>
#include <cmath>

#include "common/contact/patch/patch.hpp"
#include "common/geometry/barycentric.hpp"
#include "common/geometry/direction.hpp"

namespace palpate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLookAround = 1.5;  // radii about the sphere's middle, and as much more as it is deep,
constexpr double kDeepest = 4;       // up to so many radii
constexpr double kFacing = 0.2;      // cosine between a facet's normal and the patch's, below which it lies aside
constexpr int kTurns = 6;            // at most, of the normal towards that below the sphere's middle

// A direction across `normal` that goes along with the tool: the tool's own x axis, brought over by the least turn that
// takes its z axis into the tissue.
Vector3d across_of(const Eigen::Isometry3d& tool, const Vector3d& normal) {
  return turn_between(tool.linear().col(2), normal) * tool.linear().col(0);
}

}  // namespace

int Patch::local(int node) {
  const auto found = std::ranges::find(nodes_, node);
  if (found != nodes_.end()) return static_cast<int>(found - nodes_.begin());
  if (static_cast<int>(nodes_.size()) == kMaxNodes) return -1;
  nodes_.push_back(node);
  return static_cast<int>(nodes_.size()) - 1;
}

std::span<const int> Patch::lay(const Ground& ground, const Eigen::Isometry3d& before, const Eigen::Isometry3d& now,
                                const Vector3d& middle, double above) {
  near_ = ground.surface.near(middle, kLookAround * grid_.radius() + std::min(depth_, kDeepest * grid_.radius()));
  nodes_.clear();
  laid_at_ = middle;
  if (find_below(ground, middle, above)) {
    turn_to(before, now, middle);
    lay_feet(ground, middle);
  }
  double depth = -std::numeric_limits<double>::infinity();
  for (const Foot& f : feet_) depth = std::max(depth, f.gap);
  depth_ = std::max(depth, 0.0);
  if (nodes_.empty() || depth <= -above) lift();
  return nodes_;
}

// The patch faces the surface where the line through the sphere's middle along its normal meets it: found from where it
// faced a step ago, or from the nearest point of what comes within the sphere.
bool Patch::find_below(const Ground& ground, const Vector3d& middle, double above) {
  const SmoothSurface& surface = ground.surface;
  Vector3d out = -normal_, weights;
  if (!touches()) {
    double least = std::pow(grid_.radius() + above, 2);
    int nearest = -1;
    for (const int t : near_) {
      const ClosestPoint p = closest_point(middle, surface.corners(t));
      if (p.squared_distance >= least) continue;
      least = p.squared_distance;
      nearest = t;
      weights = p.weights;
    }
    if (nearest < 0) return false;
    anchor_ = {surface.map().triangles[nearest], weights};
    out = surface.normal(nearest, weights);
  }
  for (int turn = 0; turn < kTurns; ++turn) {
    int below = -1;
    double highest = -std::numeric_limits<double>::infinity();
    for (const int t : near_) {
      const double facing = surface.facet_normal(t).dot(out);
      if (facing < kFacing) continue;
      const Triangle c = surface.corners(t);
      const double s = surface.facet_normal(t).dot(c[0] - middle) / facing;
      const Vector3d w = plane_coordinates(c, middle + s * out);
      if (w.minCoeff() < -1e-9 || s < highest) continue;
      highest = s;
      below = t;
      weights = w;
    }
    if (below < 0) break;
    anchor_ = {surface.map().triangles[below], weights};
    const Vector3d next = surface.normal(below, weights);
    const bool done = (next - out).squaredNorm() < 1e-20;
    out = next;
    if (done) break;
  }
  normal_ = -out;
  return true;
}

void Patch::turn_to(const Eigen::Isometry3d& before, const Eigen::Isometry3d& now, const Vector3d& middle) {
  across_ = across_of(now, normal_);
  up_ = normal_.cross(across_);
  at_ = middle + grid_.radius() * normal_;
  travel_ = at_ - before * (now.inverse() * at_);
}

// Where the lines through the squares along the normal meet the surface; the outermost place counts.
void Patch::lay_feet(const Ground& ground, const Vector3d& middle) {
  const SmoothSurface& surface = ground.surface;
  for (Foot& f : feet_) f.gap = -std::numeric_limits<double>::infinity();
  for (const int t : near_) {
    if (-surface.facet_normal(t).dot(normal_) < kFacing) continue;
    const Triangle c = surface.corners(t);
    std::array<Vector2d, 3> flat;
    for (int v = 0; v < 3; ++v) flat[v] = {across_.dot(c[v] - middle), up_.dot(c[v] - middle)};
    const Vector2d e1 = flat[1] - flat[0], e2 = flat[2] - flat[0];
    const double twice = e1.x() * e2.y() - e1.y() * e2.x();
    std::array<int, 3> corners{-2, -2, -2};
    for (int p = 0; p < grid_.size(); ++p) {
      const Vector2d d = grid_.middle(p) - flat[0];
      const double w1 = (d.x() * e2.y() - d.y() * e2.x()) / twice, w2 = (e1.x() * d.y() - e1.y() * d.x()) / twice;
      if (w1 < -1e-9 || w2 < -1e-9 || w1 + w2 > 1 + 1e-9) continue;
      const Vector3d w(1 - w1 - w2, w1, w2);
      const double gap = normal_.dot(middle - (w[0] * c[0] + w[1] * c[1] + w[2] * c[2])) + grid_.rise(p);
      if (gap <= feet_[p].gap) continue;
      for (int v = 0; v < 3 && corners[v] == -2; ++v) corners[v] = local(surface.map().triangles[t][v]);
      if (std::ranges::min(corners) >= 0) feet_[p] = {corners, w, gap};
    }
  }
}

}  // namespace palpate
