#include <fmt/format.h>

#include <algorithm>

#include "common/scene/read_body.hpp"

namespace palpate {

namespace {

Shell read_shell(const TableReader& table) {
  Shell shell;
  table.number("thickness", shell.thickness, above(0), Need::required);
  table.choice("bending", shell.bending, {"discrete_kirchhoff", "polynomial"});
  table.integer("modes", shell.modes, 1, 100000);
  table.number("damping_ratio", shell.damping_ratio, at_least(0));
  table.number("damping", shell.damping, above(0));
  if (table.has("damping") && table.has("damping_ratio"))
    table.fail_at("damping", "damping and damping_ratio are two laws of damping: give one of them");
  table.flag("residual", shell.residual);
  return shell;
}

Catheter read_catheter(const TableReader& table) {
  Catheter catheter;
  table.text("inside", catheter.inside);
  table.vector("tail", catheter.tail, Need::required);
  table.vector("tip", catheter.tip, Need::required);
  const double length = (catheter.tip - catheter.tail).stableNorm();
  if (!(length > 0)) table.fail_at("tip", "the catheter's tail and tip must not coincide");
  table.number("radius", catheter.radius, above(0));
  table.integer("particles", catheter.particles, 4, 10000);
  table.number("sleeve", catheter.sleeve, at_least(0));
  if (!(catheter.sleeve < length))
    table.fail_at("sleeve", fmt::format("sleeve must be shorter than the catheter, which is {} m long, and is {}",
                                        length, catheter.sleeve));
  table.number("damping", catheter.damping, at_least(0));
  table.vector("gravity", catheter.gravity);
  table.choice("integrator", catheter.integrator, {"implicit", "semi_implicit"});
  return catheter;
}

/// Refuses the keys that go with meshes of another kind.
void refuse_keys(const TableReader& table, const Body& body) {
  const auto refuse = [&](std::string_view key, std::string_view name) {
    if (table.has(key)) table.fail_at(key, fmt::format("{} means nothing for the model '{}'", name, body.model));
  };
  if (body.model != "modal_shell") refuse("shell", "[body.shell]");
  if (body.model != "catheter") refuse("catheter", "[body.catheter]");
  if (body.model == "modal_shell" || body.model == "catheter") {
    refuse("material", "[[body.material]]");
    refuse("dynamic", "[body.dynamic]");
    refuse("tearing", "[body.tearing]");
    refuse("hybrid", "[body.hybrid]");
    refuse("nonlinear", "[body.nonlinear]");
  }
  if (body.model != "catheter") return;
  for (const char* key : {"mesh", "scale"}) refuse(key, key);
  refuse("fixed", "[[body.fixed]]");
  refuse("touchable", "[body.touchable]");
  refuse("offline", "[body.offline]");
}

}  // namespace

void read_duct(const TableReader& table, Body& body) {
  refuse_keys(table, body);
  if (body.model == "modal_shell") {
    const auto shell = table.table("shell", "[body.shell]");
    if (!shell) table.fail_at("model", "the model 'modal_shell' needs a [body.shell] that gives its thickness");
    body.shell = read_shell(*shell);
  }
  if (body.model == "catheter") {
    const auto catheter = table.table("catheter", "[body.catheter]");
    if (!catheter) table.fail_at("model", "the model 'catheter' needs a [body.catheter] that says where it lies");
    body.catheter = read_catheter(*catheter);
  }
}

void check_ducts(const std::vector<TableReader>& bodies, const Scene& scene) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto& catheter = scene.bodies[b].catheter;
    if (!catheter || catheter->inside.empty()) continue;
    const auto duct = std::ranges::find(scene.bodies, catheter->inside, &Body::name);
    if (duct != scene.bodies.end() && duct->shell) continue;
    const std::string reason = duct == scene.bodies.end() ? "the scene has no such body"
                                                          : fmt::format("that body's model is '{}'", duct->model);
    bodies[b]
        .table("catheter", "[body.catheter]")
        ->fail_at("inside", fmt::format("inside must name a body of the model 'modal_shell', and is '{}': {}",
                                        catheter->inside, reason));
  }
}

}  // namespace palpate
