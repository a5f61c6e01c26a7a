#include "common/scene/read_body.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace palpate {

void check_name(const TableReader& table, const std::string& name) {
  const auto plain = [](unsigned char c) { return c < 128 && (std::isalnum(c) || c == '_' || c == '-'); };
  if (name.size() > 31 || !std::ranges::all_of(name, plain))
    table.fail_at("name", fmt::format("name '{}' must be 1 to 31 letters, digits, '_' or '-'", name));
}

Selector read_selector(const TableReader& table, std::string_view list_key) {
  const int given = table.has(list_key) + table.has("box") + table.has("group");
  if (given != 1)
    table.fail(fmt::format("exactly one of '{}', 'box' and 'group' is needed, and there are {}", list_key, given));
  Selector where;
  table.indices(list_key, where.indices);
  table.group("group", where.group);
  if (table.has("box")) {
    const auto [low, high] = table.vector_pair("box");
    if ((low.array() > high.array()).any()) table.fail_at("box", "box must be [[least x, y, z], [greatest x, y, z]]");
    where.box = Box{low, high};
  }
  return where;
}

namespace {

const Range kPositive = above(0);
/// Positive definite elasticity that is not incompressible.
const Range kPoisson = strictly_within(-1, 0.5);

FixedRegion read_fixed(const TableReader& table, const std::string& model) {
  FixedRegion fixed;
  fixed.where = read_selector(table, "nodes");
  std::string axes = "xyz";
  table.text("axes", axes);
  fixed.axes = {false, false, false};
  for (char letter : axes) {
    const int axis = letter - 'x';
    if (axis < 0 || axis > 2 || fixed.axes[axis])
      table.fail_at("axes", fmt::format("axes '{}' must name each of x, y and z once at most", axes));
    fixed.axes[axis] = true;
  }
  if (table.has("rotations") && model != "modal_shell")
    table.fail_at("rotations",
                  fmt::format("rotations means nothing for the model '{}': a shell's nodes alone turn", model));
  table.flag("rotations", fixed.rotations);
  return fixed;
}

MaterialRegion read_material(const TableReader& table, const Material& body) {
  MaterialRegion region{read_selector(table, "elements"), body};
  if (!table.has("young") && !table.has("poisson") && !table.has("density"))
    table.fail("[[body.material]] needs at least one of 'young', 'poisson' and 'density'");
  table.number("young", region.material.young, kPositive);
  table.number("poisson", region.material.poisson, kPoisson);
  table.number("density", region.material.density, kPositive);
  return region;
}

Nonlinear read_nonlinear(const TableReader& table) {
  Nonlinear nonlinear;
  table.existing_file("force_curve", nonlinear.force_curve, Need::required);
  table.existing_file("radial_curve", nonlinear.radial_curve, Need::required);
  table.number("radius", nonlinear.specimen_radius, kPositive, Need::required);
  table.number("height", nonlinear.specimen_height, kPositive, Need::required);
  table.integer("degree", nonlinear.degree, 4, 10);
  table.existing_file("specimen_mesh", nonlinear.specimen_mesh);
  table.number("specimen_scale", nonlinear.specimen_scale, kPositive);
  if (table.has("specimen_scale") && !table.has("specimen_mesh"))
    table.fail_at("specimen_scale", "specimen_scale means nothing without 'specimen_mesh'");
  return nonlinear;
}

Offline read_offline(const TableReader& table) {
  Offline offline;
  table.integer("refine", offline.refine, 0, 2);
  table.choice("element", offline.element, {"p1", "p2"});
  table.choice("formulation", offline.formulation, {"displacement", "locking_free"});
  return offline;
}

}  // namespace

Body read_body(const TableReader& table) {
  Body body;
  table.text("name", body.name, Need::required);
  check_name(table, body.name);
  table.choice("model", body.model,
               {"quasi_static", "tensor_mass", "spring_mass", "hybrid", "modal_shell", "catheter"});
  const bool meshed = body.model != "catheter";
  if (!meshed) body.material.poisson = 0.45;
  table.number("young", body.material.young, kPositive, Need::required);
  table.number("poisson", body.material.poisson, kPoisson, meshed ? Need::required : Need::optional);
  table.number("density", body.material.density, kPositive);
  read_duct(table, body);
  if (!meshed) return body;

  table.existing_file("mesh", body.mesh, Need::required);
  table.number("scale", body.scale, kPositive);
  for (const TableReader& fixed : table.tables("fixed", "[[body.fixed]]"))
    body.fixed.push_back(read_fixed(fixed, body.model));
  if (body.fixed.empty())
    table.fail(fmt::format("body '{}' is not fixed anywhere and would float: give it a [[body.fixed]]", body.name));
  for (const TableReader& region : table.tables("material", "[[body.material]]"))
    body.materials.push_back(read_material(region, body.material));
  if (const auto nonlinear = table.table("nonlinear", "[body.nonlinear]")) body.nonlinear = read_nonlinear(*nonlinear);
  if (const auto touchable = table.table("touchable", "[body.touchable]"))
    body.touchable = read_selector(*touchable, "nodes");
  read_dynamics(table, body);
  if (const auto offline = table.table("offline", "[body.offline]")) {
    if (body.model != "quasi_static")
      table.fail_at("offline",
                    fmt::format("[body.offline] serves the model 'quasi_static' alone, and '{}' has the model '{}'",
                                body.name, body.model));
    body.offline = read_offline(*offline);
  }
  return body;
}

}  // namespace palpate
