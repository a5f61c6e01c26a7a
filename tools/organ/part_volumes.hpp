#pragma once
#include <functional>
#include <vector>

#include "tools/organ/fill_solid.hpp"

namespace palpate {

/// [m^3] Of each of so many parts.
std::vector<double> volumes_of(const FilledSolid& filled, std::size_t parts);

/// Chords of a curved surface lose volume: its nodes are moved along their normals until each part has its own [m^3],
/// more where triangles are large, since those have lost it. A part that lies within others, and has little or nothing
/// of the outer surface, has the border moved that it shares with them. `room`: Solid::room; what has none stays, and
/// the rest is moved the more.
void match_volumes(const std::vector<double>& volumes, const std::function<double(const Eigen::Vector3d&)>& room,
                   FilledSolid& filled);

}  // namespace palpate
