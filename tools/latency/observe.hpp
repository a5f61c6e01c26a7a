#pragma once
#include <memory>

#include "common/bus/bus.hpp"
#include "tools/latency/hop_times.hpp"

namespace palpate::latency {

/// Watches a running system from the side.
class HopObserver {
 public:
  explicit HopObserver(Bus& bus);
  void take();
  bool haptic_there() const { return haptic_ && haptic_->writers() > 0; }
  const HopTimes& times() const { return times_; }

 private:
  std::unique_ptr<Reader<ForceState>> haptic_;
  std::unique_ptr<Reader<SurfaceState>> surfaces_;
  std::unique_ptr<Reader<PictureState>> pictures_;
  std::unique_ptr<Reader<NodeStatus>> nodes_;
  HopTimes times_;
};

}  // namespace palpate::latency
