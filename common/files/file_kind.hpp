#pragma once
#include <filesystem>
#include <string_view>

namespace palpate {

/// What a file is by its first bytes, as the ending by which such a file goes: ".lcmlog", ".mp4", ".png", ".mcap",
/// ".h5", ".msh", ".inr", ".mha", ".nrrd", ".stl", ".vtu" (XML), ".json", ".toml", "motion" for a trajectory, or ".csv"
/// for any other text; "" of bytes that are none of these, or cannot be read.
std::string_view kind_of(const std::filesystem::path& file);

/// A kind in words: "a topic log".
std::string_view kind_in_words(std::string_view kind);

}  // namespace palpate
