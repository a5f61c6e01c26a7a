#include "tools/organ/idle_places.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/mesh/surface.hpp"
#include "tools/organ/places.hpp"

namespace palpate {
namespace {

bool reaches(const FinePlace& place, const TetMesh& mesh) {
  return std::ranges::any_of(mesh.nodes, [&](const auto& x) { return place.distance(x) <= place.edge; });
}

/// Edge [m] that is asked for where `place` is, without it.
double edge_without(const FinePlace& place, const MeshWithEdge& made, const MeshOptions& o) {
  const double edge = o.edge > 0 ? o.edge : made.mean_edge;
  const MeshSizes sizes{edge, o.inside > 0 ? std::max(o.inside, edge) : 2.5 * edge, 0, {}};
  double depth = sizes.inside;
  for (const int n : extract_surface(made.mesh).nodes) depth = std::min(depth, place.distance(made.mesh.nodes[n]));
  return asked_edge(sizes, place.low, depth);
}

}  // namespace

void warn_of_idle_places(const MeshOptions& o, const std::vector<MeshWithEdge>& made, Output& out) {
  for (const std::string& text : o.fine) {
    const FinePlace place = parse_fine_place(text);
    double longest = 0;  // of what it reaches
    for (const MeshWithEdge& one : made)
      if (reaches(place, one.mesh)) longest = std::max(longest, edge_without(place, one, o));
    if (longest == 0)
      out.warn(fmt::format("--fine {} reaches no part of the body: nothing is finer for it", text));
    else if (place.edge >= longest)
      out.warn(
          fmt::format("--fine {} asks for edges of {:.3g} mm, where they are {:.3g} mm without it: nothing is finer",
                      text, 1e3 * place.edge, 1e3 * longest));
  }
}

}  // namespace palpate
