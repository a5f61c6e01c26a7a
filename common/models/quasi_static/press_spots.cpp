#include "common/models/quasi_static/press_spots.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "common/mesh/normals.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kSpotReach = 1.2;            // of the ball's radius: what has to be smooth
constexpr double kSmooth[] = {0.8, 0.5, -1};  // cosines of the facets against the press
constexpr double kClear[] = {1.5, 0};         // radii from what is fixed

struct Candidate {
  PressedSpot spot;
  double smooth = 1;                                       // least cosine of a facet within reach
  double clear = std::numeric_limits<double>::infinity();  // [m] from what is fixed
};

double distance(const std::vector<Vector3d>& places, const Vector3d& x) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vector3d& p : places) least = std::min(least, (p - x).norm());
  return least;
}

struct Facet {
  Vector3d middle, normal;
  double size;  // [m] from the middle to the farthest corner
};

std::vector<Facet> facets_of(const SurfaceMap& s) {
  std::vector<Facet> facets;
  for (const auto& t : s.triangles) {
    const Vector3d &a = s.position[t[0]], &b = s.position[t[1]], &c = s.position[t[2]];
    const Vector3d normal = (b - a).cross(c - a).normalized(), middle = (a + b + c) / 3;
    facets.push_back({middle, normal, std::max({(a - middle).norm(), (b - middle).norm(), (c - middle).norm()})});
  }
  return facets;
}

std::vector<Candidate> candidates(const SurfaceMap& s, double radius) {
  std::vector<Vector3d> fixed, normal(s.position.size());
  for (int n = 0; n < s.size(); ++n)
    if (std::ranges::count(s.fixed[n], true) > 0) fixed.push_back(s.position[n]);
  vertex_normals(s.position, s.triangles, normal);
  const std::vector<Facet> facets = facets_of(s);
  std::vector<Candidate> all;
  for (int n = 0; n < s.touchable; ++n) {
    Candidate& c = all.emplace_back(Candidate{{s.position[n], -normal[n], radius}});
    c.clear = distance(fixed, c.spot.point);
    for (const Facet& f : facets)
      if ((f.middle - c.spot.point).norm() < std::max(kSpotReach * radius, 1.01 * f.size))
        c.smooth = std::min(c.smooth, -f.normal.dot(c.spot.inward));
  }
  return all;
}

std::vector<Candidate> serving(const std::vector<Candidate>& all, double radius, std::size_t wanted) {
  for (const double smooth : kSmooth)
    for (const double clear : kClear) {
      std::vector<Candidate> good;
      std::ranges::copy_if(all, std::back_inserter(good),
                           [&](const Candidate& c) { return c.smooth >= smooth && c.clear >= clear * radius; });
      if (good.size() >= wanted) return good;
    }
  return all;
}

}  // namespace

std::vector<PressedSpot> choose_spots(const SurfaceMap& surface, double radius, int count) {
  const auto all = serving(candidates(surface, radius), radius, static_cast<std::size_t>(count));
  Vector3d middle = Vector3d::Zero();
  for (const Candidate& c : all) middle += c.spot.point / static_cast<double>(all.size());
  std::vector<PressedSpot> spots;
  std::vector<Vector3d> taken;
  while (spots.size() < std::min<std::size_t>(count, all.size())) {
    const auto worth = [&](const Candidate& c) {
      return taken.empty() ? -(c.spot.point - middle).norm() : distance(taken, c.spot.point);
    };
    spots.push_back(std::ranges::max_element(all, {}, worth)->spot);
    taken.push_back(spots.back().point);
  }
  return spots;
}

}  // namespace palpate
