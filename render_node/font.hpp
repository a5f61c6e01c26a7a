#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace palpate {

/// Where a character lies in the atlas and how it sits on the line; pixels.
struct Glyph {
  int x = 0, y = 0, width = 0, height = 0;  ///< in the atlas
  int left = 0;                             ///< from the pen to the left edge
  int top = 0;                              ///< from the base line up to the upper edge
  float advance = 0;                        ///< from this pen position to the next
};

/// The Latin-1 characters of one font at one size, drawn once into a grey picture.
class FontAtlas {
 public:
  /// Throws std::runtime_error if the file cannot be read as a font.
  FontAtlas(const std::filesystem::path& file, int pixels);

  const Glyph& glyph(unsigned char code) const { return glyphs_[code]; }
  int line_height() const { return line_height_; }
  int ascent() const { return ascent_; }
  int width() const { return width_; }
  int height() const { return height_; }
  const std::vector<std::uint8_t>& coverage() const { return coverage_; }  ///< height x width, upper row first

 private:
  std::array<Glyph, 256> glyphs_{};
  int line_height_ = 0, ascent_ = 0;
  int width_ = 512, height_ = 0;
  std::vector<std::uint8_t> coverage_;
};

/// DejaVu Sans, as Debian's fonts-dejavu-core installs it.
std::filesystem::path default_font();

}  // namespace palpate
