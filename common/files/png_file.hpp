#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace palpate {

/// Of a picture [pixel].
struct PngSize {
  int width = 0, height = 0;
};

/// What the head of a PNG file says. Throws std::runtime_error("FILE: sentence") if it is none.
PngSize png_size(std::string_view bytes, const std::filesystem::path& file);

/// The bytes of a PNG file of at most 16 MiB, with at most `max_side` pixels a side, as its head says. Throws
/// std::runtime_error("FILE: sentence").
std::string read_png_bytes(const std::filesystem::path& file, int max_side);

}  // namespace palpate
