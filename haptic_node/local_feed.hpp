#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/realtime/latest.hpp"
#include "common/sim/haptic_step.hpp"

namespace palpate {

/// Brings local contact models from the bus to the haptic step without locks. take() runs on a thread of its own,
/// give() in the haptic loop. Subscribes to nothing in a scene without moving tissue.
class LocalFeed {
 public:
  /// `run`: of the haptic loop; models for another one are passed over.
  LocalFeed(Bus& bus, const HapticStep& haptic, std::uint64_t run);
  ~LocalFeed();

  bool needed() const { return reader_ != nullptr; }
  /// From now on models of this run of a deform node are taken, and no others; 0, as at first: none. On any thread.
  void follow(std::uint64_t deform_run) { owner_.store(deform_run, std::memory_order_relaxed); }
  /// Takes what has come.
  void take();
  /// Hands each tool's newest model to the step, if it is not the one in use. A model that names a step which is not
  /// done yet is refused: it would never be too old.
  void give(HapticStep& haptic);
  std::uint64_t refused() const { return refused_.load(std::memory_order_relaxed); }
  /// Models that cannot be of this tissue, in all.
  std::uint64_t implausible() const { return implausible_.load(std::memory_order_relaxed); }

 private:
  struct OfTool;
  std::unique_ptr<Reader<LocalContactModel>> reader_;
  std::uint64_t run_;
  std::atomic<std::uint64_t> owner_ = 0;
  const TissueLimits& limits_;
  std::vector<std::unique_ptr<OfTool>> of_tool_;
  std::unique_ptr<LocalModel> copy_;
  std::atomic<std::uint64_t> refused_ = 0, implausible_ = 0;
};

}  // namespace palpate
