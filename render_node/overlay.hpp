#pragma once
#include <vector>

#include "common/view/draw_list.hpp"
#include "render_node/font.hpp"

namespace palpate {

/// A corner of a flat triangle. Pixels from the upper left corner; texture coordinates of the font atlas.
struct FlatVertex {
  float x, y;
  float u, v;
  float red, green, blue;
  float alpha;  ///< opacity; negative: the colour scale at `red` in [0,1], opaque
};

/// Text size for a picture of this height, so that the overlay stays readable and stays small. [pixels]
int overlay_font_size(int picture_height);

/// Triangles (three vertices each) of overlay, gauge and legend, back to front.
std::vector<FlatVertex> lay_out(const Frame& frame, const FontAtlas& font, int width, int height);

/// Steps of 1, 2 or 5 times a power of ten, at most `most` of them in (0, max].
double legend_step(double max, int most);

}  // namespace palpate
