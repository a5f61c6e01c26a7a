#include "common/scene/schema.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

namespace palpate {

std::span<const TableSchema> scene_schema() {
  static const std::vector<TableSchema> schema = {
      {"scene", {"title", "body", "tool", "contact", "passivity", "network", "rates", "record", "render"}},
      {"[[body]]",
       {"name", "mesh", "scale", "model", "young", "poisson", "density", "fixed", "material", "nonlinear", "touchable",
        "offline", "dynamic", "tearing", "hybrid", "shell", "catheter"}},
      {"[[body.fixed]]", {"nodes", "box", "group", "axes", "rotations"}},
      {"[[body.material]]", {"elements", "box", "group", "young", "poisson", "density"}},
      {"[body.nonlinear]",
       {"force_curve", "radial_curve", "radius", "height", "degree", "specimen_mesh", "specimen_scale"}},
      {"[body.touchable]", {"nodes", "box", "group"}},
      {"[body.offline]", {"refine", "element", "formulation"}},
      {"[body.dynamic]", {"integrator", "precision", "step", "damping", "gravity", "corotational"}},
      {"[body.tearing]", {"criterion", "threshold"}},
      {"[body.hybrid]", {"region", "mesh", "scale"}},
      {"[[body.hybrid.region]]", {"elements", "box", "group"}},
      {"[body.shell]", {"thickness", "bending", "modes", "damping_ratio", "damping", "residual"}},
      {"[body.catheter]",
       {"inside", "tail", "tip", "radius", "particles", "sleeve", "damping", "gravity", "integrator"}},
      {"[[tool]]",
       {"name", "kind", "pivot", "axis", "up", "radius", "shaft_radius", "shaft_length", "device", "trajectory",
        "compliance", "max_force", "max_force_rate", "cautery", "jaws"}},
      {"[tool.cautery]", {"radius"}},
      {"[tool.jaws]", {"length", "width", "closed_below", "radius", "most_open", "grip_stiffness", "friction"}},
      {"[contact]", {"rule", "friction", "bucket_size"}},
      {"[passivity]", {"controller", "reserve"}},
      {"[network]", {"domain", "interface", "peers", "security"}},
      {"[network.security]", {"keys"}},
      {"[rates]", {"haptic_hz", "visual_hz"}},
      {"[record]", {"file"}},
      {"[render]", {"width", "height", "camera", "colour", "tissue_colour", "backdrop", "backdrop_scale", "overlay"}},
      {"[render.camera]", {"eye", "target", "up", "field_of_view"}},
  };
  return schema;
}

const TableSchema& table_schema(std::string_view name) {
  for (const TableSchema& table : scene_schema()) {
    if (table.name == name) return table;
  }
  throw std::logic_error("no table " + std::string(name) + " in the scene schema");
}

namespace {

/// Levenshtein distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates) {
  if (word.size() > 64) return {};
  std::string_view best;
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (std::string_view candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace palpate
