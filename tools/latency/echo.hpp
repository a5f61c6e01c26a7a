#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
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
  /// Where the middleware's own thread hands over what comes: from now on it calls `receive` with each number, until
  /// this object is gone. False, and nothing is done, where a thread has to call receive().
  virtual bool listen(const std::function<void(std::uint64_t)>& /*receive*/) { return false; }
};

enum class Side { asks, answers };

/// The project's own bus: a ToolState there, a ForceState back, as between a haptic node and a driver elsewhere.
std::unique_ptr<Echo> bus_echo(const BusSettings& settings, Side side);
/// How a message wakes who waits for it.
enum class Wake {
  waitset,  ///< a thread of the program, as the bus does
  listener  ///< none: it is served on the middleware's thread, as the vendor's ddsperf does
};
/// Bare DDS, with messages as long.
std::unique_ptr<Echo> dds_echo(const BusSettings& settings, Side side, Wake wake);
/// UDP datagrams as long. `host`: who answers. Throws std::runtime_error in one sentence.
std::unique_ptr<Echo> udp_echo(const std::string& host, int port, Side side);

}  // namespace palpate::latency
