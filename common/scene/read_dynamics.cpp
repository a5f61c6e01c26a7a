#include <fmt/format.h>

#include "common/scene/read_body.hpp"

namespace palpate {

bool is_dynamic(const Body& body) {
  return body.model == "tensor_mass" || body.model == "spring_mass" || body.model == "hybrid";
}

namespace {

Dynamic read_dynamic(const TableReader& table, const std::string& model) {
  Dynamic dynamic;
  table.choice("integrator", dynamic.integrator, {"rk4", "semi_implicit"});
  table.choice("precision", dynamic.precision, {"single", "double"});
  table.number("step", dynamic.step, at_least(0));
  table.number("damping", dynamic.damping, at_least(0));
  table.vector("gravity", dynamic.gravity);
  table.flag("corotational", dynamic.corotational);
  if (dynamic.corotational && model == "spring_mass")
    table.fail_at("corotational", "corotational is for elements, and springs turn with the tissue by themselves");
  return dynamic;
}

Tearing read_tearing(const TableReader& table) {
  Tearing tearing;
  table.choice("criterion", tearing.criterion, {"volume", "mean_elongation", "largest_elongation"});
  table.number("threshold", tearing.threshold, above(0), Need::required);
  return tearing;
}

Hybrid read_hybrid(const TableReader& table) {
  Hybrid hybrid;
  for (const TableReader& region : table.tables("region", "[[body.hybrid.region]]"))
    hybrid.regions.push_back(read_selector(region, "elements"));
  table.existing_file("mesh", hybrid.mesh);
  table.number("scale", hybrid.scale, above(0));
  if (hybrid.regions.empty() == hybrid.mesh.empty())
    table.fail(fmt::format("[body.hybrid] needs a [[body.hybrid.region]] or a 'mesh', and has {}",
                           hybrid.mesh.empty() ? "neither" : "both"));
  if (table.has("scale") && !table.has("mesh")) table.fail_at("scale", "scale means nothing without 'mesh'");
  return hybrid;
}

}  // namespace

void read_dynamics(const TableReader& table, Body& body) {
  for (const char* key : {"dynamic", "tearing", "hybrid"}) {
    const bool allowed = std::string_view(key) == "hybrid" ? body.model == "hybrid" : is_dynamic(body);
    if (table.has(key) && !allowed)
      table.fail_at(key, fmt::format("[body.{}] means nothing for the model '{}'", key, body.model));
  }
  if (body.model != "quasi_static" && body.nonlinear)
    table.fail_at(
        "nonlinear",
        fmt::format("[body.nonlinear] corrects the model 'quasi_static' alone, and the model is '{}'", body.model));
  if (const auto dynamic = table.table("dynamic", "[body.dynamic]")) body.dynamic = read_dynamic(*dynamic, body.model);
  if (const auto tearing = table.table("tearing", "[body.tearing]")) body.tearing = read_tearing(*tearing);
  if (body.model == "hybrid" && !table.has("hybrid"))
    table.fail_at("model", "the model 'hybrid' needs a [body.hybrid] that says which part is tensor-mass");
  if (const auto hybrid = table.table("hybrid", "[body.hybrid]")) body.hybrid = read_hybrid(*hybrid);
}

}  // namespace palpate
