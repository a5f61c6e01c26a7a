#pragma once
#include <array>
#include <cstdint>

#include "common/describe/state.hpp"
#include "common/tool/moving_tool.hpp"

namespace palpate {

/// How far a tool has moved since moving tissue was last known not to touch it: no deeper can it have pressed tissue,
/// nor further have drawn what it holds. Never allocates.
class ToolReach {
 public:
  static constexpr int kParts = 4;          ///< of a tool that are followed
  static constexpr std::uint64_t kLag = 5;  ///< steps from one place that is remembered to the next

  /// `at_start` [m]: how deep the tool may be in tissue before anything is known of it.
  void begin(const MovingTool& tool, double at_start);
  bool begun() const { return state_.begun; }
  /// Tissue is known not to touch it in this step.
  void set_free(const MovingTool& tool);
  double of(const MovingTool& tool) const;  ///< [m]

  void state(State& s) { s.value(state_); }

 private:
  using Ends = std::array<std::array<double, 3>, 2 * kParts>;  ///< [m] of the parts' axes, world
  static Ends ends(const MovingTool& tool);

  struct Memory {
    Ends newer{}, older{};  ///< where it was free, kLag steps apart
    double at_start = 0;    ///< [m] until it has been free
    std::uint64_t lag = 0;
    std::uint64_t begun = 0;
  };
  Memory state_;
};

}  // namespace palpate
