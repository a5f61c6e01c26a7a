#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/scene/scene.hpp"

/// What one picture shows, as plain values without any OpenGL. Lengths in metres, world frame.
namespace palpate {

/// How a mesh reflects light; only the outer side is drawn. Bone and lining (the smooth, moist wall of a cavity) are
/// backdrop: they stand still. Membrane: what lies smooth over a
/// gall bladder or a vessel, in a colour of its own. Duct and mucosa: outer and inner side of a thin-walled tube.
/// Plastic: a catheter with marks. For these three `rest` is along the straightened tube: z is the distance along it,
/// of a catheter minus that from its tip.
enum class Finish { tissue, membrane, bone, lining, duct, mucosa, plastic };

/// Whether meshes of this finish stand still behind the others.
constexpr bool in_backdrop(Finish finish) {
  return finish == Finish::bone || finish == Finish::lining;
}

/// An image that a mesh wears in place of its colour; the pixels are sRGB, upper row first, four bytes each.
struct TextureView {
  int id = 0;  ///< the renderer keeps it under this number
  int width = 0, height = 0;
  std::span<const std::uint8_t> rgba;
};

/// A triangle mesh to draw. The spans belong to the caller and must live until Renderer::draw returns.
struct MeshView {
  int id = 0;               ///< the renderer keeps its buffers under this number
  std::uint64_t shape = 0;  ///< counts changes of triangles or rest; a new value rebuilds the buffers
  Finish finish = Finish::tissue;
  std::array<double, 3> colour{0.55, 0.16, 0.13};  ///< linear RGB
  std::span<const Eigen::Vector3f> rest;           ///< [m] per vertex: what the texture sticks to
  std::span<const Eigen::Vector3f> position;       ///< [m] per vertex
  std::span<const Eigen::Vector3f> normal;         ///< unit, outward, per vertex
  std::span<const float> scalar;                   ///< [m] per vertex, coloured by Frame::legend; empty: own colour
  std::span<const Eigen::Vector2f> image;          ///< per vertex, from the texture's upper left corner; empty: none
  TextureView texture;
  std::span<const std::array<int, 3>> triangles;  ///< vertex indices, outward by the right-hand rule
  std::span<const std::array<int, 2>> edges;      ///< vertex indices of wires over it
  bool moving = true;                             ///< false: uploaded once per shape
};

/// A rigid instrument: a probe, whose spherical tip on a shaft opens into two jaws, an electric scalpel, or a forceps.
struct InstrumentView {
  Eigen::Isometry3d tip =
      Eigen::Isometry3d::Identity();  ///< z from handle to tip; origin at the tip's centre, of a forceps at the hinge
  double tip_radius = 0.004;          ///< of a probe
  bool blade = false;                 ///< the probe is a scalpel: a blade stands where its ball touches
  double shaft_radius = 0.0025;
  double shaft_length = 0.3;  ///< from the origin back along the shaft
  double jaw_opening = 0;     ///< [rad] between the jaws
  double most_open = 0;       ///< [rad] that they are shown; 0: without jaws
  double jaw_length = 0;      ///< of a forceps, from the hinge; 0: a probe
  double jaw_radius = 0.001;  ///< of a forceps' jaw about its middle line
};

/// Colour scale of MeshView::scalar; drawn at the right edge.
struct Legend {
  std::string title = "displacement";
  double max = 0.01;  ///< [m] value of the last colour; the first one is 0
};

/// A horizontal bar below the overlay's lines, with the value of its right end beside it.
struct Gauge {
  double value = 0;  ///< in the unit of `full`
  double full = 1;   ///< value at the bar's right end
  std::string unit{};
};

/// Of a picture.
enum class Corner { upper_left, upper_right, lower_left, lower_right };
constexpr bool is_right(Corner corner) {
  return corner == Corner::upper_right || corner == Corner::lower_right;
}
constexpr bool is_lower(Corner corner) {
  return corner == Corner::lower_left || corner == Corner::lower_right;
}

/// Text in a corner, one line each; UTF-8, Latin-1 range.
struct Overlay {
  std::vector<std::string> lines;
  std::optional<Gauge> gauge;
  Corner corner = Corner::upper_left;
};

struct Frame {
  Camera camera;
  double brightness = 1;  ///< [1] of the light that sits beside the camera
  std::vector<MeshView> meshes;
  std::vector<InstrumentView> instruments;  ///< at most 8
  std::optional<Legend> legend;
  std::optional<Overlay> overlay;
};

}  // namespace palpate
