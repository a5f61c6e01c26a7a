#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "tools/organ/fill_solid.hpp"

namespace palpate {

/// Around a place that a tip of this radius [m] presses: edges of half the radius, three radii wide.
FinePlace pressed_place(const Eigen::Vector3d& place, double radius);

/// Places of the tools' ends of a scene, on the ways that are written down, that lie in the box around a surface, which
/// is told by points of it [m]. Throws std::runtime_error where the scene cannot be read.
std::vector<FinePlace> pressed_places(const std::filesystem::path& scene, const std::vector<Eigen::Vector3d>& surface);

}  // namespace palpate
