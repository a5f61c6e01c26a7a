#include "common/node/topology_feed.hpp"

namespace palpate {

TopologyFeed::TopologyFeed(Bus& bus, const Presence& presence, const std::vector<Archive>& archives)
    : memory_(bus, presence, archives) {
  for (std::size_t b = 0; b < archives.size(); ++b) {
    if (archives[b].tetrahedra.empty()) continue;
    Followed& body = bodies_[static_cast<int>(b)];
    body.tetrahedra = archives[b].tetrahedra;
    body.nodes = archives[b].surface.size();
    body.mesh = std::make_unique<CutMesh>(body.tetrahedra, body.nodes);
    body.shown = std::make_unique<ShownSurface>(archives[b].surface.triangles, *body.mesh);
  }
}

std::vector<int> TopologyFeed::take() {
  std::vector<int> changed = memory_.take();
  for (const int index : changed) {
    Followed& body = bodies_.at(index);
    if (body.run != memory_.run(index)) body.mesh = std::make_unique<CutMesh>(body.tetrahedra, body.nodes);
    body.run = memory_.run(index);
    body.mesh->erase(memory_.removed(index));
  }
  return changed;
}

std::span<const int> TopologyFeed::pieces(int index) {
  Followed& body = bodies_.at(index);
  std::vector<char> joined(body.mesh->parts(body.piece), 0);
  for (const int facet : body.shown->joints())
    if (const int part = body.piece[facet / 4]; part >= 0) joined[part] = 1;
  for (int& part : body.piece)
    if (part >= 0) part = joined[part] ? 0 : part + 1;
  return body.piece;
}

std::size_t TopologyFeed::cuts() const {
  std::size_t sum = 0;
  for (const auto& [index, body] : bodies_) sum += memory_.removed(index).size();
  return sum;
}

}  // namespace palpate
