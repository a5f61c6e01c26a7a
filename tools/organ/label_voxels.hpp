#pragma once
#include <string>
#include <vector>

#include "tools/organ/finding.hpp"
#include "tools/organ/label_volume.hpp"

namespace palpate {

struct NamedLabel {
  std::int64_t label = 0;
  std::string name;
};

/// The voxels of labels in the part of an image that has them, with a rim around it, in the image's frame.
struct LabelVoxels {
  GridShape shape;
  std::vector<NamedLabel> labels;
  std::vector<std::vector<char>> inside;  ///< of each label: which voxels
};

/// Of each label the largest piece, its cavities of up to a hundredth of it filled; what that changes is noted.
/// Throws std::runtime_error where a label is not in the image, or has too few voxels to have a shape.
LabelVoxels voxels_of(const LabelVolume& volume, const std::vector<NamedLabel>& labels, std::vector<Finding>& findings);

/// Labels that hang together through faces of voxels, ascending; each is in one of these.
std::vector<std::vector<int>> touching_labels(const LabelVoxels& voxels);

/// [m] Middles of the faces of voxels between inside and outside.
std::vector<Eigen::Vector3d> border_of(const GridShape& shape, const std::vector<char>& inside);

/// [m^3]
double volume_of_voxels(const GridShape& shape, const std::vector<char>& inside);

}  // namespace palpate
