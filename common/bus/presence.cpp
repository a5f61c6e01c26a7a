#include "common/bus/presence.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <utility>

#include "common/realtime/clock.hpp"

namespace palpate {
namespace {

std::string node_name(const std::string& role) {
  char host[256] = "localhost";
  gethostname(host, sizeof host - 1);
  return fmt::format("{} {}@{}", role, getpid(), host);
}

}  // namespace

Presence::Presence(Bus& bus, std::string role, std::uint64_t run, std::string scene_hash, std::string archive_hash)
    : writer_(bus.writer(topics::node_status)), reader_(bus.reader(topics::node_status)) {
  status_.node = node_name(role);
  status_.role = std::move(role);
  status_.run = run;
  status_.scene_hash = std::move(scene_hash);
  status_.archive_hash = std::move(archive_hash);
  status_.version = PALPATE_VERSION;
  announce(0, 0, 0, 0, 0);
}

void Presence::announce(double rate_hz, std::uint64_t ticks, std::uint64_t missed, double p50_us, double p99_us, const std::string& text) {
  ++status_.seq;
  status_.stamp_ns = now_ns();
  status_.rate_hz = rate_hz;
  status_.ticks = ticks;
  status_.missed = missed;
  status_.latency_p50_us = p50_us;
  status_.latency_p99_us = p99_us;
  status_.text = text;
  if (clock_ && clock_->known()) {
    const ClockOffset::Estimate clock = clock_->estimate();
    status_.clock_of = clock_->of();
    status_.clock_offset_ns = clock.offset_ns;
    status_.clock_uncertainty_ns = clock.uncertainty_ns;
    status_.clock_drift_ppm = 1e6 * clock.drift;
  }
  writer_->write(status_);
}

bool Presence::same_scene(const NodeStatus& peer) const {
  const auto agree = [](const std::string& a, const std::string& b) { return a.empty() || b.empty() || a == b; };
  return agree(peer.scene_hash, status_.scene_hash) && agree(peer.archive_hash, status_.archive_hash);
}

std::vector<std::string> Presence::watch() {
  std::vector<std::string> said;
  while (const auto status = reader_->take()) {
    if (status->node == status_.node) continue;
    const auto known = peers_.find(status->node);
    const bool news = known == peers_.end() || known->second.run != status->run || known->second.scene_hash != status->scene_hash ||
                      known->second.archive_hash != status->archive_hash;
    peers_[status->node] = *status;
    if (!news) continue;
    if (same_scene(*status)) {
      said.push_back(fmt::format("met {}", status->node));
    } else if (status->scene_hash != status_.scene_hash) {
      said.push_back(fmt::format("refusing {}: it runs another scene (its hash {} differs from {} here)", status->node,
                                 status->scene_hash.substr(0, 12), status_.scene_hash.substr(0, 12)));
    } else {
      said.push_back(fmt::format("refusing {}: its archive is of another mesh, material or fixation (its hash {} differs from {} here)",
                                 status->node, status->archive_hash.substr(0, 12), status_.archive_hash.substr(0, 12)));
    }
  }
  return said;
}

bool Presence::accepts(std::uint64_t run) const {
  for (const auto& [node, status] : peers_)
    if (status.role == "haptic" && status.run == run) return same_scene(status);
  return false;
}

bool Presence::matched(const std::string& role) const {
  for (const auto& [node, status] : peers_)
    if (status.role == role && same_scene(status)) return true;
  return false;
}

}  // namespace palpate
