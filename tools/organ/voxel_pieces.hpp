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

/// Keeps the pieces in which a seed lies; `seeds` are indices of voxels.
void keep_pieces_with(const GridShape& shape, std::vector<char>& inside, const std::vector<std::size_t>& seeds);

/// A part of a label's voxels: larger cavities in it are meant.
inline constexpr double kSmallCavity = 0.01;

/// Fills what the voxels enclose, up to a part `largest` of them, unless `other` voxels are there, and says where that
/// is.
void fill_cavities(const GridShape& shape, std::vector<char>& inside, const std::vector<char>& other, double largest,
                   const std::string& name, std::vector<Finding>& findings);

/// Pieces and cavities, and tunnels through them. Voxels that meet in an edge or a corner alone, as steps of a slanting
/// border do, may be taken for apart or for joined, and both are the shape of the same body.
struct VoxelTopology {
  Topology apart;   ///< voxels hang together through faces, what is between them through edges and corners too
  Topology joined;  ///< the other way round
  int pieces_apart = 1, pieces_joined = 1;

  /// Whether a body may have it that is the voxels': as many as one of both, or between.
  bool allows(const Topology& body) const;
  bool allows_pieces(int pieces) const { return pieces >= pieces_joined && pieces <= pieces_apart; }
};

/// Of voxels in a grid whose rim has none.
VoxelTopology topology_of(const GridShape& shape, const std::vector<char>& inside);

}  // namespace palpate
