#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/dds_bus.hpp"

namespace palpate {

/// Numbered messages of plain bytes over the middleware's own interface, one topic out and one in: what the
/// project's bus is measured against.
class BareDds {
 public:
  /// Throws std::runtime_error in one sentence.
  BareDds(const BusSettings& settings, const std::string& out, const std::string& in);
  ~BareDds();
  BareDds(const BareDds&) = delete;

  void send(std::uint64_t seq, std::vector<std::uint8_t>& bytes);
  /// The number of the next message, 0 if none comes in time: the calling thread is woken by a wait set.
  std::uint64_t receive(std::chrono::nanoseconds timeout);
  /// From now on the middleware's own thread, which has the message from the network, hands each number to `receive`
  /// instead: as the vendor's ddsperf does. Nothing comes any more once this object is gone.
  void listen(std::function<void(std::uint64_t)> receive);

  /// Bytes with which a message is as long on the wire as a ToolState, and as a ForceState.
  static constexpr std::size_t kAsToolState = 43, kAsForceState = 47;

 private:
  std::uint64_t take();

  std::shared_ptr<const void> domain_;
  std::function<void(std::uint64_t)> heard_;
  std::int32_t participant_ = 0, writer_ = 0, reader_ = 0, waitset_ = 0;
};

}  // namespace palpate
