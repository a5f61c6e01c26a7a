#pragma once
#include <filesystem>

namespace palpate {

/// Throws std::runtime_error("FILE: reason") where a file in `folder` has the name of a picture, slice_0000.png or
/// surface.png, and was not written by this program. A folder that is not there, or has no name, has none.
void check_picture_folder(const std::filesystem::path& folder);

/// Makes the folder, and takes away the pictures that an earlier run left there. Throws std::runtime_error as above, or
/// where it cannot be made.
void make_picture_folder(const std::filesystem::path& folder);

}  // namespace palpate
