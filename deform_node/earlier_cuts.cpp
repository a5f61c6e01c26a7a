#include "deform_node/earlier_cuts.hpp"

#include <algorithm>

namespace palpate {

bool EarlierCuts::told_by_all(const Presence& presence) const {
  const auto told = [&](const std::string& node) {
    return std::ranges::all_of(bodies_, [&](int body) { return told_.contains({node, body}); });
  };
  return std::ranges::all_of(presence.peers(), [&](const auto& entry) {
    const auto& [name, peer] = entry;
    const bool follows =
        peer.accepted && (peer.status.role == "haptic" || peer.status.role == "render" || peer.status.role == "web");
    return !follows || told(name);
  });
}

bool EarlierCuts::complete(const Presence& presence, std::int64_t now_ns) {
  if (!asked_ns_) asked_ns_ = now_ns;
  while (auto held = reader_ ? reader_->take() : std::nullopt) {
    const int body = static_cast<int>(held->body);
    if (std::ranges::find(bodies_, body) == bodies_.end()) continue;
    told_.insert({held->node, body});
    another_ |= held->run != 0;
    HeldTopology& most = most_[body];
    if (held->removed.size() > most.removed.size()) most = std::move(*held);
  }
  in_time_ = now_ns - *asked_ns_ < kPatienceNs;
  if (now_ns - joined_ns_ < kMeetingNs || (in_time_ && !told_by_all(presence))) return false;
  reader_.reset();  // nobody takes from it any more: what came would fill it
  return true;
}

const HeldTopology* EarlierCuts::of(int body) const {
  const auto found = most_.find(body);
  return found == most_.end() || found->second.removed.empty() ? nullptr : &found->second;
}

}  // namespace palpate
