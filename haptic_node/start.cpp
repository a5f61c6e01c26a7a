#include "haptic_node/start.hpp"

#include <chrono>
#include <stdexcept>

#include "common/log/log.hpp"
#include "idl/topics.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;

/// Takes up what peers keep until no tool is within a body without contacts, for a second at most.
std::uint64_t resume(HapticStep& haptic, Bus& bus, Presence& presence) {
  const auto reader = bus.reader(topics::held_contacts, Keep::all);  // false ones do not take the place of true ones
  std::uint64_t refused = 0;
  const auto limit = std::chrono::steady_clock::now() + 1s;
  const auto over = [&] { return haptic.starts_inside().empty() || std::chrono::steady_clock::now() > limit; };
  while (!over()) {
    bus.wait(20ms);
    for (const std::string& said : presence.watch()) log_info(said);
    // What comes before its sender is known waits in the reader.
    const bool known = presence.matched("deform") || presence.matched("render");
    while (const auto kept = known && !over() ? reader->take() : std::nullopt)
      if (!haptic.resume(*kept) && ++refused == 1)
        log_warning("a peer keeps contacts that cannot be of this scene and these tools; they are left");
  }
  return refused;
}

}  // namespace

std::uint64_t start_tools(HapticStep& haptic, std::vector<std::unique_ptr<Device>>& devices, Bus& bus,
                          Presence& presence) {
  std::vector<ToolDofs> dofs;
  for (auto& device : devices) dofs.push_back(device->read(0).dofs);
  haptic.place(dofs);
  if (haptic.starts_inside().empty()) return 0;
  const std::uint64_t refused = resume(haptic, bus, presence);
  if (const std::string inside = haptic.starts_inside(); !inside.empty()) throw std::runtime_error(inside);
  log_info("took up the contacts that peers kept");
  return refused;
}

}  // namespace palpate
