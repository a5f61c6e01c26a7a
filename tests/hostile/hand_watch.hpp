#pragma once
#include <dds/dds.h>

#include <cstdint>
#include <vector>

#include "common/bus/dds_bus.hpp"
#include "common/bus/dds_entity.hpp"
#include "tests/hostile/felt_force.hpp"
#include "tests/realtime/host_watch.hpp"

namespace palpate::testing {

/// What the haptic node's own writer says of the tools' forces: that of others on the same topic is not looked at.
class HandWatch {
 public:
  /// In a domain that this process has joined with these settings.
  HandWatch(const BusSettings& settings, int tools);

  /// Takes what has come.
  void look();
  void begin_anew();  ///< what is told of the forces is from now on

  FeltForce& of(int tool) { return felt_[tool]; }
  int tools() const { return static_cast<int>(felt_.size()); }
  /// Of the last tool, of which each step tells last.
  const ForceState& newest() const { return felt_.back().state(); }
  /// [Hz] of the steps, by their sense times. What steps were late counts only as far as the machine did not stand, or
  /// was not taken away, whichever is more.
  double rate_hz(const HostWatch& host) const;

 private:
  Entity participant_, topic_, reader_;
  dds_instance_handle_t writer_ = 0;  ///< the first that was heard
  std::vector<FeltForce> felt_;       ///< per tool
  double stolen_before_ = 0;          ///< [s] of the machine, when it began anew
};

}  // namespace palpate::testing
