#pragma once
#include <Eigen/Geometry>
#include <span>

#include "common/contact/patch/smooth_surface.hpp"

namespace palpate {

/// The rigid motion from rest that fits the nodes about a place of the surface best, nearer ones more. Seen from there
/// tissue is deformed but little, however far it has gone and turned.
/// `place`, `within` [m]: at rest; `near`: the surface's triangles there, by SmoothSurface::near(); `positions` [m]: of
/// their nodes now.
Eigen::Isometry3d local_motion(const SmoothSurface& surface, std::span<const int> near, const Eigen::Vector3d& place,
                               double within, std::span<const Eigen::Vector3d> positions);

}  // namespace palpate
