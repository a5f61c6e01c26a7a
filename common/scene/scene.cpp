#include "common/scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace palpate {
namespace {

/// What bodies ask of one another.
void require_neighbours(Description& d, const Scene& scene) {
  const auto find = [&](const std::string& name) -> std::optional<Neighbour> {
    const auto body = std::ranges::find_if(scene.bodies, [&](const Body& b) { return name_of(b) == name; });
    if (body == scene.bodies.end()) return {};
    return Neighbour{kind_of(*body), wall_of(*body)};
  };
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    std::visit([&](const auto& spec) { require_neighbours(d, fmt::format("body.{}", b), spec, find); },
               scene.bodies[b]);
}

}  // namespace

bool has_moving_tissue(const Scene& scene) {
  return std::ranges::any_of(scene.bodies, [](const Body& body) { return owner_of(body) == Owner::deform_node; });
}

void describe(Description& d, Scene& scene) {
  d.text({"title", "", "what a person reads", Need::optional, Use::local}, scene.title);
  d.named_tables({"body", "", "the soft bodies", Need::required}, "body", scene.bodies);
  d.require(!scene.bodies.empty(), "", "the scene has no [[body]]");
  require_neighbours(d, scene);
  d.named_tables({"tool", "", "the instruments"}, "tool", scene.tools);
  d.table({"contact", "", "the law of contact", Need::optional, Use::agreed, "defaults"}, scene.contact);
  d.table({"passivity", "", "watch over the energy in the loop", Need::optional, Use::agreed, "on"}, scene.passivity);
  d.table({"network", "", "where the nodes meet", Need::optional, Use::local, "loopback"}, scene.network);
  d.table({"rates", "", "rates of the loops", Need::optional, Use::agreed, "defaults"}, scene.rates);
  d.table({"record", "", "recording", Need::optional, Use::local, "no recording"}, scene.record);
  d.table({"render", "", "the picture", Need::optional, Use::local, "defaults of the render node"}, scene.render);
  d.table({"web", "", "the live view in a browser", Need::optional, Use::local, "defaults"}, scene.web);
}

}  // namespace palpate
