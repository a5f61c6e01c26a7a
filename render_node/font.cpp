#include "render_node/font.hpp"

#include <fmt/format.h>
#include <ft2build.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include FT_FREETYPE_H

namespace palpate {
namespace {

struct FreeTypeCloser {
  void operator()(FT_Library library) const { FT_Done_FreeType(library); }
  void operator()(FT_Face face) const { FT_Done_Face(face); }
};
using Library = std::unique_ptr<std::remove_pointer_t<FT_Library>, FreeTypeCloser>;
using Face = std::unique_ptr<std::remove_pointer_t<FT_Face>, FreeTypeCloser>;

}  // namespace

FontAtlas::FontAtlas(const std::filesystem::path& file, int pixels) {
  FT_Library raw_library = nullptr;
  if (FT_Init_FreeType(&raw_library)) throw std::runtime_error("FreeType does not start");
  const Library library(raw_library);
  FT_Face raw_face = nullptr;
  if (FT_New_Face(library.get(), file.c_str(), 0, &raw_face))
    throw std::runtime_error(fmt::format("{}: not a readable font (package fonts-dejavu-core)", file.string()));
  const Face face(raw_face);
  FT_Set_Pixel_Sizes(face.get(), 0, pixels);
  line_height_ = static_cast<int>(face->size->metrics.height >> 6);
  ascent_ = static_cast<int>(face->size->metrics.ascender >> 6);

  constexpr int gap = 1;
  int x = gap + 2, y = gap,
      row_height = 2;  // the first two pixels stay full: plain areas are painted with them
  for (int code = 32; code < 256; ++code) {
    if (FT_Load_Char(face.get(), code, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT)) continue;
    const FT_GlyphSlot slot = face->glyph;
    const int w = static_cast<int>(slot->bitmap.width), h = static_cast<int>(slot->bitmap.rows);
    if (x + w + gap > width_) {
      x = gap;
      y += row_height + gap;
      row_height = 0;
    }
    glyphs_[code] = {x, y, w, h, slot->bitmap_left, slot->bitmap_top, static_cast<float>(slot->advance.x) / 64};
    height_ = std::max(height_, y + h + gap);
    coverage_.resize(static_cast<std::size_t>(width_) * height_, 0);
    for (int row = 0; row < h; ++row)
      std::copy_n(slot->bitmap.buffer + row * slot->bitmap.pitch, w, &coverage_[(y + row) * width_ + x]);
    x += w + gap;
    row_height = std::max(row_height, h);
  }
  if (height_ < 2) throw std::runtime_error(fmt::format("{}: the font has no Latin characters", file.string()));
  for (const int pixel : {0, 1, width_, width_ + 1}) coverage_[pixel] = 255;
}

std::filesystem::path default_font() {
  return "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
}

}  // namespace palpate
