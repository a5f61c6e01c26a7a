#pragma once
#include <chrono>
#include <cstdint>
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
  /// The number of the next message, 0 if none comes in time.
  std::uint64_t receive(std::chrono::nanoseconds timeout);

  /// Bytes with which a message is as long on the wire as a ToolState, and as a ForceState.
  static constexpr std::size_t kAsToolState = 43, kAsForceState = 47;

 private:
  std::shared_ptr<const void> domain_;
  std::int32_t participant_ = 0, writer_ = 0, reader_ = 0, waitset_ = 0;
};

}  // namespace palpate
