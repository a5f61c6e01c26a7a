#include "tools/replay_guard.hpp"

#include <fmt/format.h>

#include <chrono>
#include <stdexcept>
#include <utility>

#include "common/realtime/clock.hpp"
#include "common/realtime/shutdown.hpp"
#include "idl/topics.hpp"

namespace palpate {
namespace {

constexpr std::int64_t kLook = 1'000'000'000;  // [ns]

/// Whether of a topic's writers all are haptic or deform nodes.
bool is_of_nodes(std::uint32_t writers) {
  constexpr std::uint32_t kNodes = roles::haptic | roles::deform;
  return (writers & kNodes) != 0 && (writers & ~kNodes) == 0;
}

}  // namespace

ReplayGuard::ReplayGuard(Bus& bus, const std::set<std::string>& topics)
    : bus_(bus),
      moves_motors_(topics.contains(topics::force_state.name)),
      own_drivers_(topics.contains(topics::device_state.name)),
      nodes_(bus.reader(topics::node_status)),
      drivers_(bus.reader(topics::device_state)) {
  topics::for_each(
      [&](const auto& topic) { speaks_for_nodes_ |= is_of_nodes(topic.writers) && topics.contains(topic.name); });
}

void ReplayGuard::look_first() {
  const int own = std::exchange(own_drivers_, 0);  // not there yet
  for (const std::int64_t end = now_ns() + kLook; now_ns() < end && !shutdown_requested();) {
    bus_.wait(std::chrono::milliseconds(50));
    look();
    while (const auto status = nodes_->take())
      if (speaks_for_nodes_ && (status->role == "haptic" || status->role == "deform"))
        throw std::runtime_error(
            fmt::format("{} lives in {}: what is played would mix with what it says; end it, or play into another "
                        "--domain",
                        status->node, bus_.place()));
  }
  own_drivers_ = own;
}

void ReplayGuard::look() const {
  if (moves_motors_ && drivers_->writers() > own_drivers_)
    throw std::runtime_error(
        fmt::format("a driver of a device is in {}: its motors would give the forces of the log; end it, play into "
                    "another --domain, or play other topics than force_state",
                    bus_.place()));
}

}  // namespace palpate
