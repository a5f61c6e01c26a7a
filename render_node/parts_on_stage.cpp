#include "render_node/parts_on_stage.hpp"

#include <algorithm>

namespace palpate {
namespace {

std::array<int, 3> ascending(std::array<int, 3> face) {
  std::ranges::sort(face);
  return face;
}

template <class T>
void sort_once(std::vector<T>& all) {
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

std::vector<std::array<int, 2>> edges_of(std::span<const std::array<int, 3>> triangles) {
  std::vector<std::array<int, 2>> edges;
  for (const auto& [a, b, c] : triangles)
    for (const auto& [from, to] : {std::array{a, b}, std::array{b, c}, std::array{c, a}})
      edges.push_back({std::min(from, to), std::max(from, to)});
  sort_once(edges);
  return edges;
}

}  // namespace

PartsOnStage::PartsOnStage(std::span<const std::array<int, 4>> moving) {
  for (const auto& [a, b, c, d] : moving)
    for (const auto& face : {std::array{a, b, c}, std::array{a, b, d}, std::array{a, c, d}, std::array{b, c, d}})
      faces_.push_back(ascending(face));
  sort_once(faces_);
}

void PartsOnStage::sort(std::span<const std::array<int, 3>> triangles) {
  precomputed_.clear();
  moving_.clear();
  for (const auto& t : triangles)
    (std::ranges::binary_search(faces_, ascending(t)) ? moving_ : precomputed_).push_back(t);
  precomputed_edges_ = edges_of(precomputed_);
  moving_edges_ = edges_of(moving_);
}

}  // namespace palpate
