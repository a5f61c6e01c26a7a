#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <string_view>

#include "common/describe/description.hpp"
#include "common/geometry/direction.hpp"

namespace palpate {

/// The endoscope.
struct Camera {
  Eigen::Vector3d eye{0, -0.3, 0.2};
  Eigen::Vector3d target{0, 0, 0};
  Eigen::Vector3d up{0, 0, 1};
  double field_of_view = 50;  ///< [deg] vertical
};

inline void describe(Description& d, Camera& c) {
  d.vector({"eye", "m", "where it is", Need::optional, Use::local}, c.eye);
  d.vector({"target", "m", "the point in the middle of the picture", Need::optional, Use::local}, c.target);
  d.vector({"up", "", "points up in the picture", Need::optional, Use::local}, c.up);
  d.number({"field_of_view", "degree", "vertical", Need::optional, Use::local}, c.field_of_view, within(1, 170));
  const Eigen::Vector3d view = c.target - c.eye;
  d.require(safe_length(view) > 0, "", "the camera's eye and target must not coincide");
  d.require(!parallel(c.up, view), "up", "up must be a direction across the camera's line of sight");
}

/// What the tissue's colour shows.
enum class Colouring { tissue, displacement, parts };

inline const auto& words_of(Colouring) {
  static constexpr std::array<std::string_view, 3> words{"tissue", "displacement", "parts"};
  return words;
}

/// The picture.
struct Render {
  int width = 1024;
  int height = 768;
  Camera camera;
  Colouring colour = Colouring::tissue;
  std::array<double, 3> tissue_colour{0.55, 0.16, 0.13};  ///< linear RGB
  std::filesystem::path backdrop;                         ///< empty: none
  double backdrop_scale = 1;                              ///< [m per mesh unit]
  bool overlay = true;
};

inline void describe(Description& d, Render& r) {
  d.integer({"width", "pixel", "of the picture", Need::optional, Use::local}, r.width, 16, 8192);
  d.integer({"height", "pixel", "of the picture", Need::optional, Use::local}, r.height, 16, 8192);
  d.table({"camera", "", "the endoscope", Need::optional, Use::local, "defaults"}, r.camera);
  d.choice(
      {"colour", "",
       "`\"displacement\"` has a legend; `\"parts\"`: the mesh with its edges, blue what is precomputed, orange what "
       "moves with inertia (the live page draws tissue)",
       Need::optional, Use::local},
      r.colour);
  d.colour({"tissue_colour", "", "linear, each 0 to 1; a modal shell has a paler one unless this is given",
            Need::optional, Use::local},
           r.tissue_colour);
  d.file({"backdrop", "", "rigid surface behind the bodies: STL or a mesh format", Need::optional, Use::local},
         r.backdrop);
  d.number({"backdrop_scale", "m", "length of the backdrop's unit", Need::optional, Use::local}, r.backdrop_scale,
           above(0));
  d.only_with("backdrop_scale", "backdrop");
  d.flag({"overlay", "", "rates, latency and force in the picture", Need::optional, Use::local}, r.overlay);
}

}  // namespace palpate
