#include "common/bus/clock_link.hpp"

#include <fstream>
#include <utility>

namespace palpate {
namespace {

/// Changes with each start of the machine, and with it its monotonic clock.
std::string boot_id() {
  std::ifstream in("/proc/sys/kernel/random/boot_id");
  std::string id;
  in >> id;
  return id;
}

}  // namespace

ClockServer::ClockServer(Bus& bus, std::string node, ClockReading clock)
    : probes_(bus.reader(topics::clock_probe)), answers_(bus.writer(topics::clock_answer)), clock_(std::move(clock)) {
  answer_.clock_of = std::move(node);
  answer_.host = boot_id();
}

void ClockServer::answer() {
  for (int answered = 0; answered < kAtOnce; ++answered) {
    auto probe = probes_->take();
    if (!probe) return;
    answer_.receive_ns = clock_();
    answer_.node = std::move(probe->node);
    answer_.seq = probe->seq;
    answer_.probe_ns = probe->publish_ns;
    answer_.publish_ns = clock_();
    answers_->write(answer_);
  }
}

ClockFollower::ClockFollower(Bus& bus, std::string node, ClockReading clock)
    : probes_(bus.writer(topics::clock_probe)),
      answers_(bus.reader(topics::clock_answer)),
      clock_(std::move(clock)),
      host_(boot_id()) {
  probe_.node = std::move(node);
}

void ClockFollower::follow() {
  while (const auto answer = answers_->take())
    if (answer->node == probe_.node && answer->seq <= probe_.seq) take(*answer);
  const std::int64_t now = clock_();
  if (asked_ns_ != 0 && now - asked_ns_ < kIntervalNs) return;
  asked_ns_ = now;
  ++probe_.seq;
  probe_.publish_ns = now;
  probes_->write(probe_);
}

void ClockFollower::take(const ClockAnswer& a) {
  if (a.clock_of != of_) {  // another haptic node, perhaps on another machine
    offsets_ = {};
    of_ = a.clock_of;
    same_host_ = !host_.empty() && a.host == host_;
  }
  const std::int64_t now = clock_();
  offsets_.add({.sent = a.probe_ns, .received = a.receive_ns, .answered = a.publish_ns, .returned = now});
  round_trip_ = offsets_.round_trip_ns();
  const auto estimate = offsets_.at(now);
  offset_ = same_host_ || !estimate ? 0 : estimate->offset_ns;
}

ClockOffset::Estimate ClockFollower::estimate() const {
  if (same_host_) return {};
  return offsets_.at(clock_()).value_or(ClockOffset::Estimate{});
}

}  // namespace palpate
