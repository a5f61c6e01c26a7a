#include "tools/rig/surface_path.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "common/contact/patch/smooth_surface.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kSharp = 0.5;  // cosine between the normals of two facets, below which an edge of the body is between

/// Along a facet's plane, unit.
Vector3d along(const Vector3d& direction, const Vector3d& normal) {
  return (direction - direction.dot(normal) * normal).normalized();
}

/// The nearest place of the surface on the side of a triangle.
SurfacePlace nearest(const SmoothSurface& surface, const Vector3d& point, int triangle, double within) {
  std::vector<int> there;
  for (const int t : surface.near(point, within))
    if (surface.facet_normal(t).dot(surface.facet_normal(triangle)) >= kSharp) there.push_back(t);
  if (there.empty()) there.push_back(triangle);
  return nearest_place(surface, point, there);
}

bool is_free(const SurfaceMap& map, int triangle) {
  return std::ranges::all_of(map.triangles[triangle], [&](int n) {
    return n < map.touchable && !map.fixed[n][0] && !map.fixed[n][1] && !map.fixed[n][2];
  });
}

/// Whether nothing but smooth and free surface lies about a place; the far side of a thin body does not count.
bool is_open(const SmoothSurface& surface, const SurfacePlace& place, double clear) {
  return std::ranges::all_of(surface.near(place.point, clear), [&](int t) {
    const double facing = surface.facet_normal(t).dot(surface.facet_normal(place.triangle));
    if (facing < -kSharp || closest_point(place.point, surface.corners(t)).squared_distance > clear * clear)
      return true;
    return facing > kSharp && is_free(surface.map(), t);
  });
}

/// From a place on, which is not among them.
std::vector<SurfacePlace> walk(const SmoothSurface& surface, SurfacePlace from, Vector3d ahead, int steps,
                               const PathPlan& plan) {
  std::vector<SurfacePlace> places;
  for (int i = 0; i < steps; ++i) {
    ahead = along(ahead, surface.facet_normal(from.triangle));
    from = nearest(surface, from.point + plan.step * ahead, from.triangle, 2 * plan.step);
    if (!is_open(surface, from, plan.clear)) break;
    places.push_back(from);
  }
  return places;
}

}  // namespace

int nearest_triangle(const SurfaceMap& map, const Vector3d& point) {
  const auto nearest = std::ranges::min_element(map.triangles, {}, [&](const std::array<int, 3>& t) {
    return (map.position[t[0]] + map.position[t[1]] + map.position[t[2]] - 3 * point).squaredNorm();
  });
  return static_cast<int>(nearest - map.triangles.begin());
}

std::vector<SurfacePlace> places_in(const SurfaceMap& map, int triangle) {
  const SmoothSurface surface(map);
  std::vector<SurfacePlace> places{place_at(surface, triangle, Vector3d::Constant(1 / 3.0))};
  for (int v = 0; v < 3; ++v) {
    places.push_back(place_at(surface, triangle, Vector3d::Constant(0.1) + 0.7 * Vector3d::Unit(v)));
    places.push_back(place_at(surface, triangle, Vector3d::Constant(0.45) - 0.35 * Vector3d::Unit(v)));
  }
  return places;
}

SurfacePath surface_path(const SurfaceMap& map, const SurfacePlace& middle, const PathPlan& plan) {
  const SmoothSurface surface(map);
  const Triangle corners = surface.corners(middle.triangle);
  const Vector3d& normal = surface.facet_normal(middle.triangle);
  const Vector3d edge = (corners[1] - corners[0]).normalized();
  const Vector3d ahead = 2 * edge + normal.cross(edge);
  const int run_up = static_cast<int>(plan.run_up / plan.step), wanted = static_cast<int>(plan.length / plan.step);
  const int half = (run_up + wanted) / 2;
  const SurfacePlace start = nearest(surface, middle.point, middle.triangle, 2 * plan.step);
  SurfacePath path{walk(surface, start, -ahead, half, plan), run_up, plan.step};
  std::ranges::reverse(path.places);
  path.places.push_back(start);
  const auto behind = walk(surface, start, ahead, half, plan);
  path.places.insert(path.places.end(), behind.begin(), behind.end());
  if (static_cast<int>(path.places.size()) < run_up + wanted / 2)
    throw std::runtime_error("the surface has no room for a slide between edges and fixed nodes");
  return path;
}

}  // namespace palpate
