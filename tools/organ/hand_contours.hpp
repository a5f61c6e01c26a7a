#pragma once
#include <filesystem>
#include <map>

#include "tools/organ/grown_region.hpp"
#include "tools/organ/slice_contours.hpp"

namespace palpate {

/// Contours by slice, drawn by hand.
using HandContours = std::map<int, Contour>;

/// Reads lines "SLICE X Y": points in voxels, whose order in a slice is the contour's; three at least in a slice. Empty
/// lines, and what follows a #, say nothing. It may not cross itself. The contour is a smooth line through them
/// (Catmull and Rom). Throws std::runtime_error("FILE:LINE: reason").
HandContours read_hand_contours(const std::filesystem::path& file, const GridShape& shape);

/// Puts the contours into their slices of `inside`. Between two slices that are drawn, the others are drawn too, by
/// their signed distances in between (Raya and Udupa, IEEE Trans. Medical Imaging 9, 1990), if they are 16 slices apart
/// or less. Throws std::runtime_error where a contour goes around no voxel's middle.
void draw_by_hand(const HandContours& contours, const GridShape& shape, std::vector<char>& inside);

}  // namespace palpate
