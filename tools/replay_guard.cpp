#include "tools/replay_guard.hpp"

#include <fmt/format.h>

#include <chrono>
#include <stdexcept>

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

void look_who_is_there(Bus& bus, const std::set<std::string>& topics) {
  bool speaks_for_nodes = false;
  topics::for_each(
      [&](const auto& topic) { speaks_for_nodes |= is_of_nodes(topic.writers) && topics.contains(topic.name); });
  const auto nodes = bus.reader(topics::node_status);
  const auto drivers = bus.reader(topics::device_state);
  std::set<std::string> pages;  // nodes that write what drivers write, and have no motors
  for (const std::int64_t end = now_ns() + kLook; now_ns() < end && !shutdown_requested();) {
    bus.wait(std::chrono::milliseconds(50));
    while (const auto status = nodes->take()) {
      if (status->role == "web" || status->role == "ros") pages.insert(status->node);
      if (speaks_for_nodes && (status->role == "haptic" || status->role == "deform"))
        throw std::runtime_error(
            fmt::format("{} lives in {}: what is played would mix with what it says; end it, or play into another "
                        "--domain",
                        status->node, bus.place()));
    }
  }
  if (topics.contains(topics::force_state.name) && drivers->writers() > static_cast<int>(pages.size()))
    throw std::runtime_error(
        fmt::format("a driver of a device is in {}: its motors would give the forces of the log; end it, play into "
                    "another --domain, or play other topics than force_state",
                    bus.place()));
}

}  // namespace palpate
