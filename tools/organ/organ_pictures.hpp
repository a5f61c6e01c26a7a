#pragma once
#include <filesystem>

#include "tools/organ/label_solid.hpp"

namespace palpate {

/// Writes slice_0000.png and so on for slices with labels: on the left the labels and the border of the solid, on the
/// right the tetrahedra where the slice cuts them; and surface.png: the voxels and the mesh seen from one side. The
/// mesh is in the image's frame. Throws std::runtime_error where they cannot be written.
void write_organ_pictures(const LabelVolume& volume, const std::vector<NamedLabel>& labels, const Solid& solid,
                          const FilledSolid& filled, const std::filesystem::path& folder);

}  // namespace palpate
