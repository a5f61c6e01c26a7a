#pragma once
#include <string>
#include <vector>

#include "tools/organ/distance_grid.hpp"

namespace palpate {

/// Keeps the largest piece of voxels that share faces, and says of the others where they are.
void keep_largest_piece(const GridShape& shape, std::vector<char>& inside, const std::string& name,
                        std::vector<std::string>& findings);

/// Keeps the pieces in which a seed lies; `seeds` are indices of voxels.
void keep_pieces_with(const GridShape& shape, std::vector<char>& inside, const std::vector<std::size_t>& seeds);

/// Fills what the voxels enclose, unless `other` voxels are there, and says where that is.
void fill_cavities(const GridShape& shape, std::vector<char>& inside, const std::vector<char>& other,
                   const std::string& name, std::vector<std::string>& findings);

}  // namespace palpate
