#pragma once
#include <vector>

#include "tools/organ/fill_solid.hpp"
#include "tools/organ/label_solid.hpp"

namespace palpate {

/// Prints how a mesh compares with the voxels that it was made of, in the image's frame: the volume of each label, its
/// pieces and handles, and how far surface and voxels are apart. `labels`: those of its parts, of `voxels`.
void print_label_measures(const LabelVoxels& voxels, const std::vector<int>& labels, const LabelSolid& solid,
                          const FilledSolid& filled);

}  // namespace palpate
