#include "tools/latency/round_trips.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "common/realtime/clock.hpp"

namespace palpate::latency {

using namespace std::chrono_literals;

RoundTrips::RoundTrips(std::unique_ptr<Echo> echo) : echo_(std::move(echo)), sent_ns_(kUnderWay) {
  if (!echo_->listen([this](std::uint64_t seq) { came(seq); }))
    thread_ = std::jthread([this](const std::stop_token& stop) { receive(stop); });
}

RoundTrips::~RoundTrips() {
  stop();
}

// After it nothing comes any more, from the middleware's thread neither.
void RoundTrips::stop() {
  thread_ = {};
  echo_.reset();
}

void RoundTrips::send() {
  const std::uint64_t seq = next_.load(std::memory_order_relaxed);
  sent_ns_[seq % kUnderWay].store(now_ns(), std::memory_order_relaxed);
  next_.store(seq + 1, std::memory_order_release);
  echo_->send(seq);
}

std::uint64_t RoundTrips::back() const {
  return back_.load();
}

void RoundTrips::begin() {
  first_.store(next_.load());
  back_.store(0);
}

void RoundTrips::receive(const std::stop_token& stop) {
  while (!stop.stop_requested())
    if (const std::uint64_t seq = echo_->receive(20ms)) came(seq);
}

void RoundTrips::came(std::uint64_t seq) {
  const std::int64_t now = now_ns();
  const std::uint64_t first = first_.load(), next = next_.load(std::memory_order_acquire);
  if (seq >= next || seq + kUnderWay <= next) return;
  const std::int64_t sent = sent_ns_[seq % kUnderWay].exchange(0);
  if (first != from_) {
    from_ = first;
    report_ = {};
    last_ns_ = 0;
    highest_ = changes_ = 0;
  }
  if (seq < first) return;
  if (sent == 0) {
    ++report_.repeated;
    return;
  }
  report_.time.record(now - sent);
  report_.reordered += seq < highest_;
  highest_ = std::max(highest_, seq);
  if (last_ns_ > 0)
    report_.jitter_ns += (std::abs(now - sent - last_ns_) - report_.jitter_ns) / static_cast<double>(++changes_);
  last_ns_ = now - sent;
  back_.fetch_add(1);
}

RoundTripReport RoundTrips::finish() {
  const std::uint64_t sent = next_.load() - first_.load();
  for (const std::int64_t limit = now_ns() + kNsPerS; back_.load() < sent && now_ns() < limit;)
    sleep_until_ns(now_ns() + 5'000'000);
  stop();
  report_.sent = sent;
  report_.lost = sent - report_.time.count();
  return report_;
}

}  // namespace palpate::latency
