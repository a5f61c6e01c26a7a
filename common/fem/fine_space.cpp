#include "common/fem/fine_space.hpp"

#include <algorithm>
#include <stdexcept>

#include "common/fem/refine_mesh.hpp"

namespace palpate {
namespace {

/// Of the midpoint between two points of one run-time tetrahedron.
Interpolation midway(const Interpolation& a, const Interpolation& b) {
  Interpolation middle = a;
  for (int i = 0; i < middle.count; ++i) middle.weight[i] *= 0.5;
  for (int i = 0; i < b.count; ++i) {
    const auto end = middle.node.begin() + middle.count;
    const auto place = std::find(middle.node.begin(), end, b.node[i]) - middle.node.begin();
    if (place == middle.count) {
      middle.node[place] = b.node[i];
      middle.weight[place] = 0;
      ++middle.count;
    }
    middle.weight[place] += 0.5 * b.weight[i];
  }
  return middle;
}

void add_midpoints(const std::vector<std::array<int, 2>>& ends, std::vector<Interpolation>& interpolation) {
  interpolation.reserve(interpolation.size() + ends.size());
  for (const auto& [a, b] : ends) interpolation.push_back(midway(interpolation[a], interpolation[b]));
}

void make_linear(FineSpace& space) {
  space.per_element = 4;
  space.nodes = space.mesh.nodes;
  for (const auto& tet : space.mesh.tetrahedra) {
    auto& element = space.elements.emplace_back();
    element.fill(-1);
    std::copy(tet.begin(), tet.end(), element.begin());
  }
}

void make_quadratic(FineSpace& space) {
  make_linear(space);
  space.per_element = 10;
  const EdgeNumbers edges(space.mesh);
  const int first = static_cast<int>(space.nodes.size());
  for (const auto& [a, b] : edges.ends()) space.nodes.push_back(0.5 * (space.nodes[a] + space.nodes[b]));
  add_midpoints(edges.ends(), space.interpolation);
  for (auto& element : space.elements)
    for (int e = 0; e < 6; ++e) element[4 + e] = first + edges(element[kTetEdges[e][0]], element[kTetEdges[e][1]]);
}

}  // namespace

bool is_finer(const std::optional<Offline>& offline) {
  return offline && (offline->refine > 0 || offline->element != FiniteElement::p1 ||
                     offline->formulation != Formulation::displacement);
}

FineSpace make_fine_space(const TetMesh& mesh, const Offline& offline) {
  const bool linear_pressures =
      offline.element == FiniteElement::p1 && offline.formulation == Formulation::locking_free;
  if (linear_pressures && offline.refine == 0)
    throw std::runtime_error(
        "element = \"p1\" with formulation = \"locking_free\" needs refine = 1 or 2, since eight linear elements share "
        "a "
        "pressure; or take element = \"p2\"");
  FineSpace space;
  space.mesh = {mesh.nodes, mesh.tetrahedra, {}};
  for (int node = 0; node < static_cast<int>(mesh.nodes.size()); ++node)
    space.interpolation.push_back({{node, -1, -1, -1}, {1, 0, 0, 0}, 1});
  for (int level = 0; level < offline.refine; ++level) {
    auto refined = split_in_eight(space.mesh);
    add_midpoints(refined.ends, space.interpolation);
    space.children *= 8;
    space.mesh = std::move(refined.mesh);
  }
  if (linear_pressures) space.per_pressure = 8;
  if (offline.element == FiniteElement::p2)
    make_quadratic(space);
  else
    make_linear(space);
  return space;
}

}  // namespace palpate
