#include "common/view/looks.hpp"

#include <algorithm>
#include <numbers>

#include "common/models/appearance.hpp"
#include "common/tool/dofs_of.hpp"
#include "common/tool/instrument.hpp"
#include "common/view/straighten.hpp"

namespace palpate {
namespace {

// Of one body after refinement. A wall has them twice; plastic comes smooth.
constexpr std::size_t kMaxTrianglesOfOrgan = 16000, kMaxTrianglesOfWall = 6000, kMaxTrianglesOfPlastic = 0;
// Linear RGB.
constexpr std::array<double, 3> kDuctColour{0.60, 0.29, 0.23}, kPlasticColour{0.66, 0.74, 0.76};
constexpr float kBareSteel = 0.045f;  // behind a probe's tip [m]
constexpr float kBareFork = 5;        // behind a forceps' hinge [radii of the shaft]
constexpr double kProbeOpens = 1.2;   // [rad] at most, its jaws as they are shown
constexpr float kSatin = 0.35f;       // polish of a forceps: flat faces show their shape by shading

}  // namespace

BodyLook look_of(const Body& body, const SurfaceMap& surface, const Render& render) {
  const Appearance seen = std::visit([&](const auto& spec) { return appearance(spec, surface); }, body);
  const bool given = render.tissue_colour != Render{}.tissue_colour;
  switch (seen.material) {
    case Appearance::Material::wall:
      return {Finish::duct, kMaxTrianglesOfWall, given ? render.tissue_colour : kDuctColour, seen.thickness,
              straighten(surface)};
    case Appearance::Material::plastic:
      return {Finish::plastic, kMaxTrianglesOfPlastic, kPlasticColour, 0, seen.texture};
    case Appearance::Material::tissue:
      break;
  }
  return {Finish::tissue, kMaxTrianglesOfOrgan, render.tissue_colour, 0, seen.texture};
}

InstrumentView instrument_of(const Tool& tool) {
  InstrumentView view;
  view.shaft_radius = tool.shaft_radius;
  view.shaft_length = tool.shaft_length;
  const EndAbilities can = abilities_of(tool);
  if (can.ball) view.tip_radius = *can.ball;
  view.blade = can.cautery && !can.closing;
  if (can.closing) view.most_open = kProbeOpens;
  if (can.turning) {
    view.most_open = std::numbers::pi;
    view.jaw_length = can.turning->length;
    view.jaw_radius = can.turning->radius;
  }
  return view;
}

Steel steel_of(const InstrumentView& instrument) {
  if (instrument.jaw_length > 0) return {kSatin, kBareFork * static_cast<float>(instrument.shaft_radius)};
  return {1, kBareSteel};
}

void place(InstrumentView& instrument, const Trocar& trocar, const ToolState& s) {
  instrument.tip = tip_pose(trocar, dofs_of(s));
  const bool forceps = instrument.jaw_length > 0;
  instrument.jaw_opening = std::clamp(forceps ? s.opening : s.grip, 0.0, instrument.most_open);
}

Camera fit_camera(std::span<const SurfaceMap> surfaces) {
  Eigen::AlignedBox3d box;
  for (const SurfaceMap& map : surfaces)
    for (const auto& p : map.position) box.extend(p);
  Camera camera;
  if (box.isEmpty()) return camera;
  camera.target = box.center();
  camera.eye = box.center() + box.diagonal().norm() * Eigen::Vector3d(0.15, -0.85, 0.75);
  return camera;
}

}  // namespace palpate
