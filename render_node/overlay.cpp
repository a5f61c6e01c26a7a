#include "render_node/overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace palpate {
namespace {

struct Paint {
  float red, green, blue, alpha;
};
constexpr Paint kPanelPaint{0.02f, 0.02f, 0.025f, 0.58f};
constexpr Paint kTextPaint{0.93f, 0.94f, 0.92f, 1};
constexpr Paint kGroovePaint{0.35f, 0.36f, 0.38f, 0.8f};
constexpr Paint kGaugePaint{0.36f, 0.78f, 0.55f, 1};
constexpr Paint kFullPaint{0.93f, 0.42f, 0.26f, 1};

/// UTF-8 to Latin-1; what Latin-1 lacks becomes '?'.
std::string to_latin1(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x80) {
      out += text[i];
    } else if ((byte == 0xC2 || byte == 0xC3) && i + 1 < text.size()) {
      out += static_cast<char>(((byte & 3) << 6) | (static_cast<unsigned char>(text[++i]) & 0x3F));
    } else if (byte >= 0xC0) {
      out += '?';
    }
  }
  return out;
}

class Sheet {
 public:
  explicit Sheet(const FontAtlas& font) : font_(font) {}

  void area(float x, float y, float w, float h, const Paint& p) {
    const float u = 1.0f / font_.width(), v = 1.0f / font_.height();  // between the atlas's full pixels
    quad({x, y, u, v, p.red, p.green, p.blue, p.alpha}, {x + w, y + h, u, v, p.red, p.green, p.blue, p.alpha});
  }

  /// A vertical run of the colour scale, its first colour at the bottom.
  void scale(float x, float y, float w, float h) {
    const FlatVertex high{x, y, 0, 0, 1, 0, 0, -1}, low{x + w, y + h, 0, 0, 0, 0, 0, -1};
    FlatVertex high2 = high, low2 = low;
    high2.x = low.x;
    low2.x = high.x;
    vertices_.insert(vertices_.end(), {high, high2, low, high, low, low2});
  }

  /// `y` is the base line.
  void text(float x, float y, std::string_view words, const Paint& p) {
    for (const char c : to_latin1(words)) {
      const Glyph& g = font_.glyph(static_cast<unsigned char>(c));
      const float left = std::round(x) + g.left, top = y - g.top;
      const float u = 1.0f / font_.width(), v = 1.0f / font_.height();
      quad(
          {left, top, g.x * u, g.y * v, p.red, p.green, p.blue, p.alpha},
          {left + g.width, top + g.height, (g.x + g.width) * u, (g.y + g.height) * v, p.red, p.green, p.blue, p.alpha});
      x += g.advance;
    }
  }

  float width_of(std::string_view words) const {
    float width = 0;
    for (const char c : to_latin1(words)) width += font_.glyph(static_cast<unsigned char>(c)).advance;
    return width;
  }

  std::vector<FlatVertex> take() { return std::move(vertices_); }

 private:
  void quad(const FlatVertex& a, const FlatVertex& c) {
    FlatVertex b = a, d = c;
    b.x = c.x, b.u = c.u;
    d.x = a.x, d.u = a.u;
    vertices_.insert(vertices_.end(), {a, b, c, a, c, d});
  }

  const FontAtlas& font_;
  std::vector<FlatVertex> vertices_;
};

void add_gauge(Sheet& sheet, const Gauge& gauge, float x, float y, float wide, const FontAtlas& font) {
  const float line = font.line_height(), share = std::clamp<float>(gauge.value / gauge.full, 0, 1);
  const std::string end = fmt::format("{:g} {}", gauge.full, gauge.unit);
  const float bar = std::ceil(wide) - sheet.width_of(end) - 0.6f * line;
  const float top = std::round(y + 0.35f * line), height = std::round(0.35f * line);
  sheet.area(x, top, bar, height, kGroovePaint);
  sheet.area(x, top, std::round(share * bar), height, share < 0.9f ? kGaugePaint : kFullPaint);
  sheet.text(x + bar + 0.6f * line, std::round(y + font.ascent()), end, kTextPaint);
}

void add_overlay(Sheet& sheet, const Overlay& overlay, const FontAtlas& font, int width, int height) {
  const float line = font.line_height(), margin = 0.6f * line;
  float widest = overlay.gauge ? 9 * line : 0;
  for (const std::string& words : overlay.lines) widest = std::max(widest, sheet.width_of(words));
  const std::size_t lines = overlay.lines.size() + (overlay.gauge ? 1 : 0);
  if (lines == 0) return;
  const float wide = std::ceil(widest) + 2 * margin, tall = static_cast<float>(lines) * line + margin;
  const float left = is_right(overlay.corner) ? width - margin - wide : margin;
  const float top = is_lower(overlay.corner) ? height - margin - tall : margin;
  sheet.area(left, top, wide, tall, kPanelPaint);
  float y = top + 0.5f * margin;
  for (const std::string& words : overlay.lines) {
    sheet.text(left + margin, std::round(y + font.ascent()), words, kTextPaint);
    y += line;
  }
  if (overlay.gauge) add_gauge(sheet, *overlay.gauge, left + margin, y, widest, font);
}

void add_legend(Sheet& sheet, const Legend& legend, const FontAtlas& font, int width, int height) {
  const float line = font.line_height(), bar = line, tall = std::round(0.42f * height);
  const double max_mm = 1e3 * legend.max, step = legend_step(max_mm, 5);
  const int digits = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  const std::string title = legend.title + " [mm]";
  const float wide = std::max(sheet.width_of(title), bar + 4 * line) + line;
  const float x = width - wide - 0.6f * line, y = std::round(0.5f * (height - tall));
  sheet.area(x, y - 2 * line, wide, tall + 3 * line, kPanelPaint);
  sheet.text(x + 0.5f * line, y - line, title, kTextPaint);
  sheet.scale(x + 0.5f * line, y, bar, tall);
  for (double mark = 0; mark <= max_mm * (1 + 1e-9); mark += step) {
    const float at = std::round(y + tall * static_cast<float>(1 - mark / max_mm));
    sheet.area(x + 0.5f * line + bar, at, 0.3f * line, 1, kTextPaint);
    sheet.text(x + line + bar, at + std::round(0.36f * font.ascent()), fmt::format("{:.{}f}", mark, digits),
               kTextPaint);
  }
}

}  // namespace

int overlay_font_size(int picture_height) {
  return std::clamp(picture_height / 52, 10, 40);
}

double legend_step(double max, int most) {
  const double coarse = max / most, decade = std::pow(10.0, std::floor(std::log10(coarse)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= coarse * (1 - 1e-9)) return factor * decade;
  return 10 * decade;
}

std::vector<FlatVertex> lay_out(const Frame& frame, const FontAtlas& font, int width, int height) {
  Sheet sheet(font);
  if (frame.overlay) add_overlay(sheet, *frame.overlay, font, width, height);
  if (frame.legend) add_legend(sheet, *frame.legend, font, width, height);
  return sheet.take();
}

}  // namespace palpate
