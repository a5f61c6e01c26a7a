#pragma once
#include <string_view>
#include <vector>

#include "tools/organ/finding.hpp"
#include "tools/organ/polygons.hpp"

namespace palpate {

/// Reads the vertices and faces of an OBJ file; notes lines that say something else of the shape, and names of groups,
/// which are not kept. Throws std::runtime_error("line 3: reason").
Polygons read_obj_polygons(std::string_view bytes, std::vector<Finding>& findings);

}  // namespace palpate
