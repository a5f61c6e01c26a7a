#include "common/bus/presence.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "common/describe/printable.hpp"
#include "common/realtime/clock.hpp"

namespace palpate {
namespace {

constexpr std::int64_t kForgottenAfterNs = 600 * kNsPerS;
constexpr std::string_view kRecorder = "recorder";
constexpr std::int64_t kAliveNs = 5 * kNsPerS / 2;     // each node says once a second how it is
constexpr std::int64_t kStoodNs = 2 * kNsPerS;         // one that only stood for a moment has said so again by then
constexpr std::int64_t kNoticedNs = 3 * kNsPerS / 10;  // an end shows so long after it at most
constexpr std::int64_t kBeginningNs = 3 * kNsPerS;     // in which two that began at once have heard of each other
constexpr std::size_t kMaxPeers = 256;
constexpr const char* kRefused =
    "messages are refused: what they say cannot be, there are too many of them, or they are in another node's name";
constexpr int kMaxTold = 8;     // sentences about one of them
constexpr int kMaxSaid = 1024;  // about all of them, until the first ones are forgotten

std::string also(const std::string& first, const std::string& second) {
  return first.empty() ? second : first + "; " + second;
}

void make_printable(NodeStatus& status) {
  for (std::string* text : {&status.node, &status.role, &status.scene_hash, &status.archive_hash, &status.version,
                            &status.clock_of, &status.text})
    *text = printable(*text);
}

std::string node_name(const std::string& role) {
  char host[256] = "localhost";
  gethostname(host, sizeof host - 1);
  return fmt::format("{} {}@{}", role, getpid(), host);
}

}  // namespace

Presence::Presence(Bus& bus, std::string role, std::uint64_t run, std::string scene_hash, std::string archive_hash)
    : bus_(&bus), writer_(bus.writer(topics::node_status)), reader_(bus.reader(topics::node_status)) {
  status_.node = node_name(role);
  status_.role = std::move(role);
  status_.run = run;
  status_.scene_hash = std::move(scene_hash);
  status_.archive_hash = std::move(archive_hash);
  status_.version = PALPATE_VERSION;
  announce(0, 0, 0, 0, 0);
}

void Presence::announce(double rate_hz, std::uint64_t ticks, std::uint64_t missed, double p50_us, double p99_us,
                        const std::string& text) {
  ++status_.seq;
  status_.stamp_ns = now_ns();
  status_.rate_hz = rate_hz;
  status_.ticks = claimed_.empty() ? ticks : std::max<std::uint64_t>(ticks, 1);  // 0: it has not begun
  status_.missed = missed;
  status_.latency_p50_us = p50_us;
  status_.latency_p99_us = p99_us;
  status_.text = bus_->refused() > told_refused_ ? also(text, kRefused) : text;
  told_refused_ = bus_->refused();
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
  // A recorder has no scene; nobody else may leave out which it has.
  if (peer.role == kRecorder || status_.role == kRecorder) return true;
  return peer.scene_hash == status_.scene_hash && peer.archive_hash == status_.archive_hash;
}

std::string Presence::meet(const NodeStatus& peer) const {
  if (same_scene(peer)) return "met " + peer.node;
  const auto differs = [&](const char* what, const std::string& theirs, const std::string& ours) {
    return fmt::format("refusing {}: {} (its hash {} differs from {} here)", peer.node, what, theirs.substr(0, 12),
                       ours.substr(0, 12));
  };
  if (peer.scene_hash != status_.scene_hash)
    return differs("it runs another scene", peer.scene_hash, status_.scene_hash);
  return differs("its archive is of another mesh, material or boundary conditions", peer.archive_hash,
                 status_.archive_hash);
}

std::vector<std::string> Presence::watch() {
  std::vector<std::string> said = bus_->misfits();
  if (!said_refused_ && bus_->refused() > 0) said.emplace_back(kRefused);
  said_refused_ = bus_->refused() > 0;
  const std::int64_t now = now_ns();
  while (auto status = reader_->take()) {
    make_printable(*status);
    if (status->node != status_.node) hear(*status, now, said);
  }
  while (auto ended = reader_->take_ended()) {
    const auto peer = peers_.find(printable(ended->node));
    if (peer != peers_.end()) peer->second.ended_ns = now;
  }
  std::erase_if(peers_, [&](const auto& entry) { return now - entry.second.heard_ns > kForgottenAfterNs; });
  return said;
}

// Who is heard and has this scene gives way to nobody.
bool Presence::make_room(const NodeStatus& newcomer, std::int64_t now) {
  const bool of_this_scene = same_scene(newcomer);
  const auto may_go = [&](const Peer& peer) {
    return !peer.accepted || (of_this_scene && now - peer.heard_ns >= kAliveNs);
  };
  auto least = peers_.end();
  for (auto it = peers_.begin(); it != peers_.end(); ++it) {
    const auto worth = [](const Peer& peer) { return std::pair(peer.accepted, peer.heard_ns); };
    if (may_go(it->second) && (least == peers_.end() || worth(it->second) < worth(least->second))) least = it;
  }
  if (least == peers_.end()) return false;
  peers_.erase(least);
  return true;
}

bool Presence::may_say(std::int64_t now) {
  if (now - saying_ns_ > kForgottenAfterNs) said_ = 0, saying_ns_ = now;
  return ++said_ <= kMaxSaid;
}

void Presence::hear(const NodeStatus& status, std::int64_t now, std::vector<std::string>& said) {
  if (peers_.size() >= kMaxPeers && !peers_.contains(status.node) && !make_room(status, now)) return;
  Peer& peer = peers_[status.node];
  const NodeStatus& before = peer.status;
  const bool news = before.node.empty() || before.run != status.run || before.scene_hash != status.scene_hash ||
                    before.archive_hash != status.archive_hash;
  peer.status = status;
  peer.ended_ns = 0;
  peer.heard_ns = now;
  if (!news) return;
  peer.met_ns = now;
  peer.accepted = same_scene(status);
  if (++peer.told <= kMaxTold && may_say(now)) said.push_back(meet(status));
}

bool Presence::accepts(std::uint64_t run) const {
  const Peer* haptic = holder("haptic");
  return haptic && haptic->status.run == run;
}

bool Presence::is_rival(const Peer& peer, std::int64_t now) const {
  return (peer.accepted || claimed_of_ == Of::domain) && peer.status.role == status_.role && peer.status.run != 0 &&
         now - peer.heard_ns < kAliveNs;
}

// Of two that begin at once one gives way: the same one for both.
const NodeStatus* Presence::owner() const {
  const std::int64_t now = now_ns();
  for (const auto& [name, peer] : peers_) {
    const NodeStatus& s = peer.status;
    if (is_rival(peer, now) && (s.ticks > 0 || s.run < status_.run)) return &s;
  }
  return nullptr;
}

std::string Presence::fight_with(const NodeStatus& other, const std::string& what) const {
  return fmt::format("{} has {} in {}: a second owner would fight with it. Stop it, or give another --domain",
                     other.node, what, bus_->place());
}

void Presence::claim(const std::string& what, Of of) {
  claimed_of_ = of;
  if (const NodeStatus* other = owner()) throw std::runtime_error(fight_with(*other, what));
  claimed_ = what;
  claim_ns_ = now_ns();
  announce(0, 0, 0, 0, 0);
}

std::string Presence::lost_claim() const {
  const std::int64_t now = now_ns();
  if (claimed_.empty() || now - claim_ns_ > kBeginningNs) return {};
  for (const auto& [name, peer] : peers_)
    if (is_rival(peer, now) && peer.status.ticks > 0 && peer.status.run < status_.run)
      return fight_with(peer.status, claimed_);
  return {};
}

const Presence::Peer* Presence::holder(const std::string& role) const {
  const std::int64_t now = now_ns();
  const Peer *first = nullptr, *standing = nullptr, *last = nullptr;
  const auto take_earlier = [](const Peer*& of, const Peer& peer) {
    if (!of || peer.met_ns < of->met_ns) of = &peer;
  };
  for (const auto& [name, peer] : peers_) {
    if (!peer.accepted || peer.status.role != role) continue;
    if (!last || peer.met_ns >= last->met_ns) last = &peer;
    const std::int64_t silent = now - peer.heard_ns;
    if (peer.ended_ns == 0 && silent < kAliveNs) take_earlier(first, peer);
    if (peer.ended_ns != 0 && silent < kStoodNs) take_earlier(standing, peer);
  }
  const bool intruder =
      standing && first && standing->met_ns < first->met_ns && first->met_ns < standing->ended_ns - kNoticedNs;
  if (intruder) return standing;
  return first ? first : last;
}

}  // namespace palpate
