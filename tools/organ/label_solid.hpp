#pragma once
#include <vector>

#include "tools/organ/label_voxels.hpp"
#include "tools/organ/organ_mesh.hpp"

namespace palpate {

struct LabelShape {
  double smoothing = 1;  ///< [voxels along each axis] over which the border is smoothed
  double gap = 0;        ///< [m] at least, between a label and those that are not in its solid
};

/// Labels of an image as solids, their parts in the order of `labels`, in the image's frame.
struct LabelSolid {
  Solid solid;
  SolidMeasures measures;
  std::vector<double> volumes;          ///< [m^3] of each label's voxels, less the gap
  std::vector<Eigen::Vector3d> border;  ///< [m] middles of the voxel faces around all of them
};

/// Surfaces are where a smoothed distance to the voxels' border has the level that keeps each label's volume. Several
/// labels share their border; with a gap, `labels` is one. Walls thinner than three widths of the smoothing are
/// smoothed over a third of their thickness, along each axis where that is less, which is noted, as is what is filled
/// between them. Throws std::runtime_error where the gap leaves next to nothing of a label.
LabelSolid solid_of(const LabelVoxels& voxels, const std::vector<int>& labels, const LabelShape& wish,
                    std::vector<Finding>& findings);

}  // namespace palpate
