#include "common/files/png_file.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <stdexcept>

namespace palpate {
namespace {

constexpr std::string_view kPngMark = "\x89PNG\r\n\x1a\n";
constexpr std::size_t kWidthAt = 16, kHeightAt = 20, kHead = 24;
constexpr std::uintmax_t kMaxPngBytes = 16u << 20;

std::uint32_t big_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (const char byte : bytes.substr(at, 4)) value = value << 8 | static_cast<unsigned char>(byte);
  return value;
}

[[noreturn]] void refuse_png(const std::filesystem::path& file, const std::string& sentence) {
  throw std::runtime_error(file.string() + ": " + sentence);
}

}  // namespace

PngSize png_size(std::string_view bytes, const std::filesystem::path& file) {
  if (bytes.size() < kHead || !bytes.starts_with(kPngMark) || bytes.substr(12, 4) != "IHDR")
    refuse_png(file, "this is no PNG image");
  const std::uint32_t width = big_endian(bytes, kWidthAt), height = big_endian(bytes, kHeightAt);
  constexpr std::uint32_t kMaxSide = 0x7fffffff;
  if (width == 0 || height == 0 || width > kMaxSide || height > kMaxSide) refuse_png(file, "the image has no size");
  return {static_cast<int>(width), static_cast<int>(height)};
}

std::string read_png_bytes(const std::filesystem::path& file, int max_side) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) refuse_png(file, "the file cannot be read: " + error.message());
  if (size > kMaxPngBytes) refuse_png(file, "the image has more than " + std::to_string(kMaxPngBytes) + " bytes");
  std::string bytes(size, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(in.gcount()) != size) refuse_png(file, "the file cannot be read");
  const PngSize png = png_size(bytes, file);
  if (std::max(png.width, png.height) > max_side)
    refuse_png(file, "the image has " + std::to_string(png.width) + " x " + std::to_string(png.height) +
                         " pixels, and may have " + std::to_string(max_side) + " a side");
  return bytes;
}

}  // namespace palpate
