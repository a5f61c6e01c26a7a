#pragma once
#include <vector>

#include "tools/organ/fill_solid.hpp"
#include "tools/organ/label_solid.hpp"

namespace palpate {

/// Tells how a mesh in the image's frame compares with the voxels that it was made of: the volume of each label, its
/// pieces and handles, and how far surface and voxels are apart. Warns of a volume that is off, and where pieces,
/// closed surfaces or handles are others than those of the voxels. `labels`: those of its parts, of `voxels`.
void tell_label_measures(const LabelVoxels& voxels, const std::vector<int>& labels, const LabelSolid& solid,
                         const FilledSolid& filled, Output& out);

}  // namespace palpate
