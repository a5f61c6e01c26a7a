#pragma once
#include <array>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/tool/kinematics.hpp"
#include "common/view/draw_list.hpp"
#include "idl/messages.hpp"

/// How the parts of a scene look, whoever draws them.
namespace palpate {

// Linear RGB.
inline constexpr std::array<double, 3> kBoneColour{0.80, 0.68, 0.54}, kLiningColour{0.46, 0.20, 0.165},
    kMucosaColour{0.58, 0.27, 0.19};

struct BodyLook {
  Finish finish = Finish::tissue;        ///< of the outer side
  std::size_t max_triangles = 0;         ///< after refinement: what 60 frames a second allow
  std::array<double, 3> colour{};        ///< linear RGB
  double thickness = 0;                  ///< [m] of a wall, else 0
  std::vector<Eigen::Vector3f> texture;  ///< [m] coordinates that the texture sticks to, per surface node; empty: rest
};

/// `render`: whose tissue colour is also a wall's, if it is given.
BodyLook look_of(const Body& body, const SurfaceMap& surface, const Render& render);

/// A tool's instrument, not placed yet.
InstrumentView instrument_of(const Tool& tool);

/// What `metal` is told of an instrument.
struct Steel {
  float polish;  ///< 1 mirrors most, 0 is satin
  float bare;    ///< [m] of bare steel behind the tip
};
Steel steel_of(const InstrumentView& instrument);

/// Puts an instrument where its tool's state says.
void place(InstrumentView& instrument, const Trocar& trocar, const ToolState& state);

/// A camera that sees all the bodies, from in front (-y) and above.
Camera fit_camera(std::span<const SurfaceMap> surfaces);

}  // namespace palpate
