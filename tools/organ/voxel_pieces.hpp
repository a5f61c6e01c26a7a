#pragma once
#include <string>
#include <vector>

#include "tools/organ/distance_grid.hpp"
#include "tools/organ/finding.hpp"
#include "tools/organ/mesh_pieces.hpp"

namespace palpate {

/// Keeps the largest piece of voxels that share faces, and says of the others where they are.
void keep_largest_piece(const GridShape& shape, std::vector<char>& inside, const std::string& name,
                        std::vector<Finding>& findings);

/// Fills what the voxels enclose, up to a hundredth of them, unless `other` voxels are there, and says where that is.
void fill_cavities(const GridShape& shape, std::vector<char>& inside, const std::vector<char>& other,
                   const std::string& name, std::vector<Finding>& findings);

/// Of voxels that hang together through faces: pieces and cavities, and tunnels through them.
Topology topology_of(const GridShape& shape, const std::vector<char>& inside);

}  // namespace palpate
