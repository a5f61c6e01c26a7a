#pragma once
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "common/bus/dds_bus.hpp"

namespace palpate::latency {

/// A way by which numbered messages go to another process and come back. The asking side numbers them from 1; the other
/// side sends back every number that it receives.
class Echo {
 public:
  virtual ~Echo() = default;
  virtual void send(std::uint64_t seq) = 0;
  /// The next number that comes, 0 if none does in time. May be called from another thread than send().
  virtual std::uint64_t receive(std::chrono::nanoseconds timeout) = 0;
};

enum class Side { asks, answers };

/// The project's own bus: a ToolState there, a ForceState back, as between a haptic node and a driver elsewhere.
std::unique_ptr<Echo> bus_echo(const BusSettings& settings, Side side);
/// Bare DDS, with messages as long.
std::unique_ptr<Echo> dds_echo(const BusSettings& settings, Side side);
/// UDP datagrams as long. `host`: who answers. Throws std::runtime_error in one sentence.
std::unique_ptr<Echo> udp_echo(const std::string& host, int port, Side side);

}  // namespace palpate::latency
