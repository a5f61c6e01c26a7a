#pragma once
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace palpate {

/// Upper row first, four bytes a pixel: red, green, blue, 255.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;

  const std::uint8_t* pixel(int x, int y) const { return &rgba[4 * (static_cast<std::size_t>(y) * width + x)]; }
};

/// Of a file that has no name until it is whole: a reader never sees half a picture. It says by which software it was
/// made. Throws std::runtime_error("FILE: reason"), leaving nothing.
void write_png(const Image& image, const std::filesystem::path& file);

/// Whether a file is a picture that `write_png` wrote.
bool is_own_png(const std::filesystem::path& file);

/// From the bytes of a PNG file, whose name is said where they are none. Throws std::runtime_error("FILE: reason").
Image decode_png(std::string_view bytes, const std::filesystem::path& file);

/// Throws std::runtime_error("FILE: reason") if the file is missing or not a PNG.
Image read_png(const std::filesystem::path& file);

}  // namespace palpate
