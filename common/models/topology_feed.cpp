#include "common/models/topology_feed.hpp"

#include <algorithm>

namespace palpate {

TopologyFeed::TopologyFeed(Bus& bus, const Presence& presence, const std::vector<Archive>& archives)
    : bus_(bus), presence_(presence), reader_(bus.reader(topics::topology_change, Keep::all)) {
  for (std::size_t b = 0; b < archives.size(); ++b) {
    if (archives[b].tetrahedra.empty()) continue;
    Followed& body = bodies_[static_cast<int>(b)];
    body.tetrahedra = archives[b].tetrahedra;
    body.nodes = archives[b].surface.size();
    body.mesh = std::make_unique<CutMesh>(body.tetrahedra, body.nodes);
    body.shown = std::make_unique<ShownSurface>(archives[b].surface.triangles, *body.mesh);
  }
}

// The run of the deformation node that is known, 0 for none.
std::uint64_t TopologyFeed::owner() const {
  std::int64_t newest = 0;
  std::uint64_t run = 0;
  for (const auto& [name, peer] : presence_.peers()) {
    if (peer.role != "deform" || peer.run == 0 || peer.stamp_ns < newest) continue;
    newest = peer.stamp_ns;
    run = peer.run;
  }
  return run;
}

void TopologyFeed::start_again(std::vector<int>& changed) {
  for (auto& [index, body] : bodies_) {
    if (body.seq == 0) continue;
    body.mesh = std::make_unique<CutMesh>(body.tetrahedra, body.nodes);
    body.seq = 0;
    changed.push_back(index);
  }
  cuts_ = 0;
}

bool TopologyFeed::apply(const TopologyChange& change, std::vector<int>& changed) {
  const auto found = bodies_.find(static_cast<int>(change.body));
  if (found == bodies_.end()) return false;
  Followed& body = found->second;
  const auto fits = [&](std::uint32_t t) { return t < body.tetrahedra.size(); };
  if (!std::ranges::all_of(change.removed, fits)) return false;
  if (change.seq <= body.seq) return true;
  const std::vector<int> gone(change.removed.begin(), change.removed.end());
  body.mesh->erase(gone);
  body.seq = change.seq;
  cuts_ += gone.size();
  changed.push_back(found->first);
  return true;
}

std::vector<int> TopologyFeed::take() {
  std::vector<int> changed;
  const std::uint64_t owner = this->owner();
  if (owner != 0 && owner != run_) {
    start_again(changed);
    run_ = owner;
    reader_ = bus_.reader(topics::topology_change, Keep::all);  // what came before it was known comes again
  }
  while (const auto change = reader_->take()) {
    if (change->run != run_) continue;
    const auto body = bodies_.find(static_cast<int>(change->body));
    if (body != bodies_.end() && change->seq > body->second.seq + 1) {
      start_again(changed);
      reader_ = bus_.reader(topics::topology_change, Keep::all);
      continue;
    }
    refused_ += !apply(*change, changed);
  }
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  return changed;
}

}  // namespace palpate
