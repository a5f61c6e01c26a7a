#pragma once
#include <Eigen/Core>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/contact/patch/surface_place.hpp"

namespace palpate {

/// The triangle whose middle is nearest to a point.
int nearest_triangle(const SurfaceMap& map, const Eigen::Vector3d& point);

/// Seven places all over a triangle: near its corners, near its edges, in its middle; pressed along the surface's
/// normal, which turns evenly from corner to corner.
std::vector<SurfacePlace> places_in(const SurfaceMap& map, int triangle);

/// A way over a surface as it is wanted, all in metres.
struct PathPlan {
  double length;  ///< that is measured
  double run_up;  ///< before that
  double step;    ///< from place to place
  double clear;   ///< from edges of the body, from what is fixed and from what cannot be touched
};

/// Places in even steps, straight through each triangle and straight on beyond its edges, pressed along the surface's
/// normal, which turns evenly from corner to corner.
struct SurfacePath {
  std::vector<SurfacePlace> places;
  int run_up;   ///< so many of them come before what is measured
  double step;  ///< [m]

  double at(std::size_t place) const { return step * (static_cast<double>(place) - run_up); }  ///< [m] along
};

/// A path with a place in its middle, oblique to the edges of that place's triangle; shorter where there is no room.
/// Throws std::runtime_error where there is room for less than half of it.
SurfacePath surface_path(const SurfaceMap& map, const SurfacePlace& middle, const PathPlan& plan);

}  // namespace palpate
