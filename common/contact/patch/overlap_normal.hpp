#pragma once
#include <Eigen/Core>
#include <span>

#include "common/contact/patch/smooth_surface.hpp"

namespace palpate {

/// Outward, not of unit length: the mean over what a ball has passed of the surface at rest, by the facets' own
/// normals. A place counts by (a^2 - r^2)^2, a being the radius of the disc that the ball cuts out of the facet's plane
/// and r the distance from its middle: as near to the middle as Hertz's pressures are. So a ball between the edges is
/// pushed along the facet's normal, as the flat face does, and over an edge the normal turns evenly. Zero where the
/// ball has passed nothing. Facets count the less the more they turn away from `out` (unit), up to those of a cosine of
/// `facing`.
Eigen::Vector3d overlap_normal(const SmoothSurface& surface, std::span<const int> triangles,
                               const Eigen::Vector3d& middle, double radius, const Eigen::Vector3d& out, double facing);

}  // namespace palpate
