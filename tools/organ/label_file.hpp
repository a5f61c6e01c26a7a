#pragma once
#include <filesystem>

#include "tools/organ/label_volume.hpp"

namespace palpate {

/// Writes voxels as labels 0 and 1 in a volume's frame: MetaImage (.mha), NRRD (.nrrd) or INR (.inr), whole or not at
/// all. INR has no place for origin and axes. Throws std::runtime_error("FILE: reason").
void write_label_volume(const GreyVolume& frame, const std::vector<char>& inside, const std::filesystem::path& file);

}  // namespace palpate
