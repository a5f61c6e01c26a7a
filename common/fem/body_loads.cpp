#include "common/fem/body_loads.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "common/fem/selection.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

constexpr double kMostForce = 1e9;  // [N], far above what tissue bears, so that nothing overflows

}  // namespace

StaticLoads body_loads(const MeshedSpec& body, const std::vector<std::array<int, 3>>& triangles,
                       const SelectNodes& select) {
  StaticLoads loads;
  for (std::size_t i = 0; i < body.loads.size(); ++i) {
    const LoadSpec& load = body.loads[i];
    const std::string place = fmt::format("body '{}': [[body.load]] {}", body.name, i + 1);
    const std::vector<int> nodes = select(load.where, place);
    if (nodes.empty()) throw std::runtime_error(place + " selects no node");
    if (load.pressure != 0) {
      const auto on = pressures_on(triangles, nodes, load.pressure);
      if (on.empty()) throw std::runtime_error(place + ": none of its nodes make a triangle of the surface");
      loads.pressures.insert(loads.pressures.end(), on.begin(), on.end());
    } else if (!load.force.isZero(0)) {
      if (const double most = load.force.cwiseAbs().maxCoeff(); !(most < kMostForce))
        throw std::runtime_error(fmt::format("{}: a force of {:.3g} N, more than there is", place, most));
      for (const int node : nodes) loads.nodes.push_back({node, load.force / static_cast<double>(nodes.size())});
    }
  }
  return loads;
}

StaticLoads body_loads(const MeshedSpec& body, const TetMesh& mesh) {
  if (body.loads.empty()) return {};
  return body_loads(body, extract_surface(mesh).triangles,
                    [&](const Selector& where, const std::string& place) { return select_nodes(mesh, where, place); });
}

}  // namespace palpate
