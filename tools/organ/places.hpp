#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "tools/organ/fill_solid.hpp"

namespace palpate {

/// Finite numbers with one character between two; empty where it is anything else.
std::vector<double> numbers_of(std::string_view text, char between = ',');

/// Reads "x,y,z,RADIUS:EDGE" (a ball) or "x,y,z,x,y,z:EDGE" (two corners of a box) [m]. Throws std::runtime_error.
FinePlace parse_fine_place(const std::string& text);

/// Throws std::runtime_error where a group's text is not as add_group() has it, or its name another's or `taken`.
void check_groups(const std::vector<std::string>& texts, const std::vector<std::string>& taken = {});

/// Reads "NAME=PLACE" and gives the mesh a group of its surface nodes there. PLACE: "box:x,y,z,x,y,z" [m],
/// "plane:x,y,z,nx,ny,nz" (behind a plane through a point, its normal pointing away), "below:AXIS" or "above:AXIS"
/// (the tenth of the mesh that lies lowest or highest along x, y or z), "below:AXIS:VALUE" or "above:AXIS:VALUE" [m].
/// Throws std::runtime_error where it says something else, or no node lies there.
void add_group(TetMesh& mesh, const std::string& text);

/// Of places on a surface [m] the one that lies farthest from those in a group (as add_group() has it): where
/// `palpate scene` puts the tool of a body that is held there. Throws std::runtime_error where none is in the group.
Eigen::Vector3d farthest_from_group(const std::string& group, const std::vector<Eigen::Vector3d>& surface);

}  // namespace palpate
