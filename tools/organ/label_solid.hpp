#pragma once
#include <string>
#include <vector>

#include "tools/organ/label_volume.hpp"
#include "tools/organ/organ_mesh.hpp"

namespace palpate {

struct NamedLabel {
  int label = 0;
  std::string name;
};

/// Labels of an image as solids, their parts in the order of `labels`, in the image's frame.
struct LabelSolid {
  Solid solid;
  SolidMeasures measures;
  std::vector<double> volumes;                                ///< [m^3] of each label's voxels that are kept
  std::vector<Eigen::Vector3d> border;                        ///< [m] middles of the voxel faces around all of them
  std::function<double(const Eigen::Vector3d&)> from_voxels;  ///< [m] to the border of the voxels, not smoothed
  std::vector<std::string> findings;                          ///< what is left out or filled, with its place
};

/// Surfaces are where a smoothed distance to the voxels' border has the level that keeps each label's volume; the
/// distance is smoothed over `smoothing` voxels along each axis. Of each label the largest piece is kept, and
/// cavities in it are filled. Labels that touch share their border.
/// Throws std::runtime_error where a label is not in the image.
LabelSolid solid_of(const LabelVolume& volume, const std::vector<NamedLabel>& labels, double smoothing);

}  // namespace palpate
