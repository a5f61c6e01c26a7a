#pragma once
#include <dds/dds.h>

#include <cstdint>
#include <optional>

#include "common/bus/dds_bus.hpp"
#include "common/bus/dds_entity.hpp"
#include "idl/messages.hpp"
#include "tests/realtime/host_watch.hpp"

namespace palpate::testing {

/// What the haptic node's own writer says of one tool's force: that of others on the same topic is not looked at.
class HandWatch {
 public:
  /// In a domain that this process has joined with these settings.
  HandWatch(const BusSettings& settings, std::uint32_t tool);

  /// Takes what has come.
  void look();
  void begin_anew();  ///< what is told below is from now on

  double max_force() const { return max_force_; }  ///< [N]
  double max_rise() const { return max_rise_; }    ///< [N] from one step to the next
  bool finite() const { return finite_; }
  double rate_hz(const HostWatch& host) const;  ///< of the steps, by their sense times, while the machine ran
  std::uint64_t steps() const { return steps_; }
  const ForceState& newest() const { return newest_; }

 private:
  void add(const ForceState& force);

  std::uint32_t tool_;
  Entity participant_, topic_, reader_;
  dds_instance_handle_t writer_ = 0;  ///< the first that was heard
  ForceState newest_;
  std::optional<ForceState> first_;
  std::uint64_t steps_ = 0;
  double max_force_ = 0, max_rise_ = 0;
  bool finite_ = true;
};

}  // namespace palpate::testing
