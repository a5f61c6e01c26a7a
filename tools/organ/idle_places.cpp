#include "tools/organ/idle_places.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/mesh/surface.hpp"
#include "tools/organ/places.hpp"

namespace palpate {

void warn_of_idle_places(const MeshOptions& o, const TetMesh& mesh, double mean_edge, Output& out) {
  const double edge = o.edge > 0 ? o.edge : mean_edge;
  const MeshSizes sizes{edge, o.inside > 0 ? std::max(o.inside, edge) : 2.5 * edge, 0, {}};
  const std::vector<int> surface = extract_surface(mesh).nodes;
  for (const std::string& text : o.fine) {
    const FinePlace place = parse_fine_place(text);
    if (std::ranges::none_of(mesh.nodes, [&](const auto& x) { return place.distance(x) <= place.edge; })) {
      out.warn(fmt::format("--fine {} reaches no part of the body: nothing is finer for it", text));
      continue;
    }
    double depth = sizes.inside;
    for (const int n : surface) depth = std::min(depth, place.distance(mesh.nodes[n]));
    if (const double there = asked_edge(sizes, place.low, depth); place.edge >= there)
      out.warn(
          fmt::format("--fine {} asks for edges of {:.3g} mm, where they are {:.3g} mm without it: nothing is finer",
                      text, 1e3 * place.edge, 1e3 * there));
  }
}

}  // namespace palpate
