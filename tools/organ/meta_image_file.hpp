#pragma once
#include <cstdint>
#include <string>

namespace palpate {

/// Looks at the header of a MetaImage (.mha, .mhd) before ITK does. Throws std::runtime_error(reason) where it has not
/// two or three axes: it would be read for minutes.
void check_meta_image_axes(const std::string& file);

/// Whether the voxels of a MetaImage, so many bytes, are all in its file or in one beside it, compressed or not; ITK
/// fills what is not there with zeros. True of text beside it, and of several files, which are not looked at.
/// Throws std::runtime_error(reason) where compressed bytes are broken, or their number is not in the header.
bool holds_all_voxels(const std::string& file, std::int64_t bytes);

}  // namespace palpate
