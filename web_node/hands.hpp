#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "common/tool/kinematics.hpp"
#include "idl/messages.hpp"
#include "web_node/protocol.hpp"

namespace palpate::web {

/// A tool that a person may take.
struct OfferedTool {
  bool offered = false;
  Trocar trocar;
};

/// Whose hand holds which tool: one page at most, and another may ask for it. Times are seconds on this host's clock.
class Hands {
 public:
  /// Seconds without a sample after which a tool is free for who asks.
  static constexpr double kIdle = 3;

  /// Numbers its samples on the bus from `first` on.
  Hands(std::vector<OfferedTool> tools, std::uint64_t first);

  /// A page wants the tool: it gets it if no other holds it, and else has asked for it.
  void take(int tool, std::uint32_t page, double now);
  void release(int tool, std::uint32_t page);  ///< goes to who has asked
  void give(int tool, std::uint32_t page);     ///< its holder's word: to who has asked
  void gone(std::uint32_t page);               ///< the page has been closed

  /// What the haptic node is told of a sample; empty where the page does not hold the tool, or has told the number
  /// before.
  std::optional<DeviceState> move(int tool, std::uint32_t page, const Sample& sample, double now);

  struct View {
    std::uint32_t holder = 0, asker = 0;
    std::uint32_t sample = 0;  ///< the holder's number of `device_seq`, 0 if that is older than when it took the tool
    bool offered = false;
  };
  View view(int tool, std::uint64_t device_seq) const;

 private:
  struct Held {
    OfferedTool tool;
    std::uint32_t holder = 0, asker = 0, number = 0;
    std::uint64_t base = 0, seq = 0;           ///< of the bus: when the tool was taken; told last
    double heard = 0;                          ///< [s]
    std::array<std::uint32_t, 256> numbers{};  ///< of the page, which leaves some out, for the bus's last ones
  };
  bool known(int tool) const { return tool >= 0 && tool < static_cast<int>(held_.size()); }
  static void hand_over(Held& held, std::uint32_t page);

  mutable std::mutex mutex_;  ///< pages speak on one thread, frames are made on another
  std::vector<Held> held_;
};

}  // namespace palpate::web
