#include "tools/study/slides.hpp"

#include <stdexcept>

#include "tools/rig/slide.hpp"

namespace palpate::study {
namespace {

void add_slide(SolidCase& solid, Scene scene, const Archive& archive, const Row& of, double friction, double spread,
               Result& result) {
  scene.contact.friction = friction;
  PressRig rig(scene, {archive});
  const double depth = solid.presses().deepest();
  const auto& reference = solid.slide_reference(depth);
  const auto ticks = slide(rig, solid.slide_path(), solid.presses().radius, depth);
  const auto trend = std::span(reference).last(ticks.size());
  const SlideMeasures m = measure_slide(ticks, trend, rig.dt());
  if (!(m.mean > 0)) throw std::runtime_error("the ball meets no force along it");
  result.touches.push_back(
      {of.scene, of.method, of.knob, of.value, friction, m.mean, m.ripple, m.jump, m.turn, m.buzz, spread});
  for (std::size_t i = 0; i < ticks.size(); ++i)
    result.slides.push_back({of.scene, of.method, of.knob, of.value, friction, ticks[i].path, ticks[i].force,
                             ticks[i].tangential, trend[i]});
}

}  // namespace

void add_slides(SolidCase& solid, const Scene& scene, const Archive& archive, const Row& of,
                const std::vector<double>& shares, Result& result) {
  const double spread = shares.empty() ? kUnknown : spread_of(shares);
  try {
    const Scene alone = solid.press_scene(scene, 0);
    add_slide(solid, alone, archive, of, 0, spread, result);
    add_slide(solid, alone, archive, of, 0.3, kUnknown, result);
  } catch (const std::runtime_error& error) {
    result.touches.push_back(
        {.scene = of.scene, .method = of.method, .knob = of.knob, .value = of.value, .spread = spread});
    result.notes.push_back({of.scene, of.method, of.knob, of.value, std::string("no slide: ") + error.what()});
  }
}

std::vector<double> press_around(SolidCase& solid, int patch, PressRig& rig) {
  const Presses& presses = solid.presses();
  const auto places = places_in(solid.surface(), presses.patches[patch].triangle);
  auto forces = press_places(rig, places, presses.radius, presses.deepest());
  for (double& force : forces) force /= solid.fine(patch).back().force;
  return forces;
}

}  // namespace palpate::study
