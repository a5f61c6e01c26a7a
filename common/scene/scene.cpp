#include "common/scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace palpate {
namespace {

/// A catheter is led into a shell.
void require_ducts(Description& d, const Scene& scene) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto* wire = as<CatheterSpec>(scene.bodies[b]);
    if (!wire || wire->catheter.inside.empty()) continue;
    const std::string& inside = wire->catheter.inside;
    const auto duct = std::ranges::find_if(scene.bodies, [&](const Body& body) { return name_of(body) == inside; });
    const bool found = duct != scene.bodies.end();
    const std::string reason =
        !found ? "the scene has no such body" : fmt::format("that body's model is '{}'", kind_of(*duct));
    d.require(found && as<ShellSpec>(*duct), fmt::format("body.{}.catheter.inside", b),
              fmt::format("inside must name a body of the model 'modal_shell', and is '{}': {}", inside, reason));
  }
}

}  // namespace

void describe(Description& d, Scene& scene) {
  d.text({"title", "", "what a person reads", Need::optional, Use::local}, scene.title);
  d.named_tables({"body", "", "the soft bodies", Need::required}, "body", scene.bodies);
  d.require(!scene.bodies.empty(), "", "the scene has no [[body]]");
  require_ducts(d, scene);
  d.named_tables({"tool", "", "the instruments"}, "tool", scene.tools);
  d.table({"contact", "", "the law of contact", Need::optional, Use::agreed, "defaults"}, scene.contact);
  d.table({"passivity", "", "watch over the energy in the loop", Need::optional, Use::agreed, "on"}, scene.passivity);
  d.table({"network", "", "where the nodes meet", Need::optional, Use::local, "loopback"}, scene.network);
  d.table({"rates", "", "rates of the loops", Need::optional, Use::agreed, "defaults"}, scene.rates);
  d.table({"record", "", "recording", Need::optional, Use::local, "no recording"}, scene.record);
  d.table({"render", "", "the picture", Need::optional, Use::local, "defaults of the render node"}, scene.render);
}

}  // namespace palpate
