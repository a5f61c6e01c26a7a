#include "common/node/topology_memory.hpp"

#include <algorithm>

#include "common/realtime/clock.hpp"

namespace palpate {
namespace {

constexpr std::int64_t kIntervalNs = 50'000'000;
constexpr std::int64_t kPatienceNs = 1'000'000'000;
constexpr std::int64_t kAtOnceNs = 2'000'000;  // for what has come, since the caller has more to do

/// [bytes] A body loses each tetrahedron once in a run; those of a run that has ended may still wait.
std::size_t room_for_changes(const std::vector<Archive>& archives) {
  std::size_t tetrahedra = 0;
  for (const Archive& archive : archives) tetrahedra += archive.tetrahedra.size();
  return 2 * sizeof(std::uint32_t) * tetrahedra;
}

}  // namespace

TopologyMemory::TopologyMemory(Bus& bus, const Presence& presence, const std::vector<Archive>& archives)
    : bus_(bus), presence_(presence), room_(room_for_changes(archives)), writer_(bus.writer(topics::held_topology)) {
  for (std::size_t b = 0; b < archives.size(); ++b) {
    if (archives[b].tetrahedra.empty()) continue;
    Followed& body = bodies_[static_cast<int>(b)];
    body.tetrahedra = archives[b].tetrahedra.size();
    body.told.node = presence.node();
    body.told.body = static_cast<std::uint32_t>(b);
  }
  listen();
  tell(now_ns());
}

void TopologyMemory::listen() {
  reader_ = bus_.reader(topics::topology_change, Keep::all, room_);
}

// The first change of a run has all that was gone before it. One that does not fit counts as seen: asked for anew, it
// would come again and again.
bool TopologyMemory::apply(const TopologyChange& change, Followed& body) {
  if (change.seq == 1) body.removed.clear(), body.cut.clear();
  const bool fits = body.removed.size() + change.removed.size() <= body.tetrahedra &&
                    std::ranges::all_of(change.removed, [&](std::uint32_t t) { return t < body.tetrahedra; });
  if (fits) body.removed.insert(body.removed.end(), change.removed.begin(), change.removed.end());
  if (fits && change.cause == RemovalCause::cut)
    body.cut.insert(body.cut.end(), change.removed.begin(), change.removed.end());
  body.run = change.run;
  body.seq = change.seq;
  body.news = true;
  return fits;
}

void TopologyMemory::take_changes(std::vector<int>& changed) {
  const std::int64_t begin = now_ns();
  while (now_ns() - begin < kAtOnceNs) {
    const auto change = reader_->take();
    if (!change) return;
    const auto found = bodies_.find(static_cast<int>(change->body));
    if (change->run != run_) continue;
    if (found == bodies_.end()) {
      ++refused_;
      continue;
    }
    Followed& body = found->second;
    const std::uint64_t next = change->run == body.run ? body.seq + 1 : 1;
    if (change->seq < next) continue;
    if (change->seq > next) {
      lacks_ = true;
      continue;
    }
    if (apply(*change, body))
      changed.push_back(found->first);
    else
      ++refused_;
  }
}

// All changes come again, from every writer: not at any rate, whatever numbers come.
void TopologyMemory::ask_anew(std::int64_t now) {
  if (!lacks_ || now - asked_ns_ < kPatienceNs) return;
  lacks_ = false;
  asked_ns_ = now;
  listen();
}

void TopologyMemory::tell(std::int64_t now) {
  for (auto& [index, body] : bodies_) {
    if (!body.news || now - body.told_ns < kIntervalNs) continue;
    HeldTopology& m = body.told;
    m.seq = m.run == body.run ? m.seq + 1 : 1;
    m.run = body.run;
    m.removed.assign(body.removed.begin(), body.removed.end());
    body.news = !writer_->write(m);
    body.told_ns = now;
  }
}

std::vector<int> TopologyMemory::take() {
  std::vector<int> changed;
  const Presence::Peer* owner = presence_.holder("deform");
  if (owner && owner->status.run != 0 && owner->status.run != run_) {
    run_ = owner->status.run;
    listen();  // what came before it was known comes again
  }
  take_changes(changed);
  ask_anew(now_ns());
  tell(now_ns());
  std::ranges::sort(changed);
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  return changed;
}

}  // namespace palpate
