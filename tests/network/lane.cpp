#include "tests/network/lane.hpp"

#include <algorithm>
#include <string>

namespace palpate::testing {
namespace {

constexpr std::int64_t kOvertakenNs = 5'000'000;

std::int64_t ns(double seconds) {
  return static_cast<std::int64_t>(1e9 * seconds);
}

}  // namespace

bool change(Impairment& impairment, std::istream& words) {
  for (std::string key; words >> key;) {
    if (key == "clear") {
      impairment = {};
      continue;
    }
    double value = 0;
    if (!(words >> value) || value < 0) return false;
    if (key == "delay")
      impairment.delay = value;
    else if (key == "jitter")
      impairment.jitter = value;
    else if (key == "loss")
      impairment.loss = value;
    else if (key == "duplicate")
      impairment.duplicate = value;
    else if (key == "reorder")
      impairment.reorder = value;
    else if (key == "rate")
      impairment.rate = value;
    else if (key == "queue")
      impairment.queue = value;
    else if (key == "cut")
      impairment.cut = value != 0;
    else
      return false;
  }
  return true;
}

void Lane::set(const Impairment& impairment) {
  impairment_ = impairment;
  if (impairment.rate == 0) line_free_ = 0;
  if (!impairment.cut) return;
  waiting_.clear();
  last_due_ = 0;
}

void Lane::put(std::span<const std::uint8_t> packet, std::int64_t now_ns) {
  if (impairment_.cut || chance(impairment_.loss)) return;
  send(packet, now_ns);
  if (chance(impairment_.duplicate)) send(packet, now_ns);
}

std::optional<Lane::Packet> Lane::take(std::int64_t now_ns) {
  if (next_due() > now_ns) return std::nullopt;
  return std::move(waiting_.extract(waiting_.begin()).mapped());
}

// When the packet's last bit has left, empty if the queue before the line is full.
std::optional<std::int64_t> Lane::cross_line(std::size_t bytes, std::int64_t now_ns) {
  if (impairment_.rate == 0) return now_ns;
  const double ns_per_byte = 8e9 / impairment_.rate;
  const auto size = static_cast<double>(bytes);
  line_free_ = std::max(line_free_, now_ns);
  if (static_cast<double>(line_free_ - now_ns) / ns_per_byte + size > impairment_.queue) return std::nullopt;
  return line_free_ += static_cast<std::int64_t>(size * ns_per_byte);
}

void Lane::send(std::span<const std::uint8_t> packet, std::int64_t now_ns) {
  const std::optional<std::int64_t> sent = cross_line(packet.size(), now_ns);
  if (!sent) return;
  std::int64_t due = *sent + ns(impairment_.delay + impairment_.jitter * uniform());
  if (chance(impairment_.reorder))
    due = std::max(due, last_due_) + kOvertakenNs;
  else
    due = last_due_ = std::max(due, last_due_);
  waiting_.emplace(due, Packet(packet.begin(), packet.end()));
}

}  // namespace palpate::testing
