#pragma once
#include <filesystem>
#include <string_view>

namespace palpate {

/// Whether a file's name ends so, in capitals or not; `ending`: in small letters, as ".nii.gz".
bool has_ending(const std::filesystem::path& file, std::string_view ending);

}  // namespace palpate
