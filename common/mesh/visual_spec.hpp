#pragma once
#include <filesystem>

#include "common/describe/description.hpp"

namespace palpate {

/// A surface that is drawn in place of the body's own: finer, and of several materials.
struct VisualSpec {
  std::filesystem::path surface;    ///< triangles
  std::filesystem::path materials;  ///< MTL; empty: all of it has the tissue's colour
  std::filesystem::path texture;    ///< PNG; empty: none
  double scale = 1;                 ///< [m per unit of the surface]
};

inline void describe(Description& d, VisualSpec& v) {
  d.file({"surface", "", "triangles about where the body's surface is: Wavefront OBJ, STL or a mesh format",
          Need::required, Use::local},
         v.surface);
  d.file({"materials", "", "colours of an OBJ's materials: MTL", Need::optional, Use::local}, v.materials);
  d.file({"texture", "", "image for the texture coordinates of an OBJ: PNG, 4096 pixels a side at most", Need::optional,
          Use::local},
         v.texture);
  d.number({"scale", "m", "length of the surface's unit", Need::optional, Use::local}, v.scale, above(0));
}

}  // namespace palpate
