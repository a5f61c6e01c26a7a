#pragma once
#include <chrono>
#include <cstdint>
#include <memory>

#include "common/bus/dds_bus.hpp"
#include "tests/bus/domain.hpp"

namespace palpate::testing {

/// Follows haptic nodes of this process's domain, one after another, by their forces.
class ForcesOfRuns {
 public:
  /// Waits for this step of the haptic node that is there, of another one than before; false after a minute.
  bool reach(std::uint64_t step) {
    using namespace std::chrono_literals;
    const auto limit = std::chrono::steady_clock::now() + 60s;
    for (; std::chrono::steady_clock::now() < limit; bus_->wait(10ms))
      while (const auto force = forces_->take()) {
        if (force->run == run_ || force->step < step) continue;
        run_ = force->run;
        return true;
      }
    return false;
  }

 private:
  std::unique_ptr<Bus> bus_ = make_dds_bus({.domain = own_domain()});
  std::unique_ptr<Reader<ForceState>> forces_ = bus_->reader(topics::force_state);
  std::uint64_t run_ = 0;  ///< of the haptic node that was there
};

}  // namespace palpate::testing
