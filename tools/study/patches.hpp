#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/scene/scene.hpp"
#include "tools/rig/surface_path.hpp"

namespace palpate::study {

/// A place of the surface that is pressed: a point within a triangle, neither a node nor the middle, pressed against
/// the triangle's own normal.
using Patch = SurfacePlace;

/// Presses of physical size, the same for all methods.
struct Presses {
  double radius = 0;           ///< [m] of the ball
  std::string radius_from;     ///< where it comes from, in words
  std::vector<double> depths;  ///< [m] ascending, from first touch
  std::vector<Patch> patches;
  std::vector<int> nodes;  ///< of the mesh, the nearest to each patch

  double deepest() const { return depths.back(); }
};

/// The ball is the tip of the scene's first probe; without one its radius is the surface's mean edge. Depths
/// go up to half the radius. Places: touchable triangles away from fixed nodes where the surface is smooth,
/// the first the farthest from all fixed nodes and each following one the farthest from those chosen. The
/// same surface gives the same places. Throws std::runtime_error if no triangle serves.
Presses choose_presses(const Scene& scene, const SurfaceMap& surface, bool quick);

}  // namespace palpate::study
