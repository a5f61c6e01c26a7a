#include "common/bus/waiting_room.hpp"

namespace palpate {

bool WaitingRoom::enter(std::uint64_t writer, std::uint64_t peer, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  const auto known = writers_.find(writer);
  if (known != writers_.end()) peer = known->second.peer;
  const auto of_peer = of_peers_.find(peer);
  const std::size_t waiting = of_peer == of_peers_.end() ? 0 : of_peer->second;
  if (samples_ >= kSamples || bytes_ + bytes > kBytes || waiting + bytes > each_) return false;
  Writer& of_writer = writers_[writer];
  of_writer.peer = peer;
  ++of_writer.samples;
  of_peers_[peer] = waiting + bytes;
  ++samples_;
  bytes_ += bytes;
  return true;
}

void WaitingRoom::leave(std::uint64_t writer, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  const auto found = writers_.find(writer);
  if (found == writers_.end()) return;
  const std::uint64_t peer = found->second.peer;
  --samples_;
  bytes_ -= bytes;
  if ((of_peers_[peer] -= bytes) == 0) of_peers_.erase(peer);
  if (--found->second.samples == 0) writers_.erase(found);
}

}  // namespace palpate
