#pragma once
#include <Eigen/Core>
#include <span>

namespace palpate {

/// [m] Where places in single precision are counted from: of a grid of 16 m, the point nearest to the middle of these
/// points' box. So a body within 8 m is exact to half a micrometre wherever it is, and one about the world's origin is
/// counted from there.
Eigen::Vector3d near_origin(std::span<const Eigen::Vector3d> points);

}  // namespace palpate
