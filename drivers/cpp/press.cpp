// A driver in C++: publishes a tool's position a thousand times a second and takes the force for the motors.
//   press DOMAIN [TOOL [FROM TO]]
// DOMAIN: of the running system on this host. TOOL: its place in the scene's list, from 0. FROM, TO: depths beyond the
// trocar [m], between which the emulated hardware goes in and out. For hardware of your own, replace Hardware.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <numbers>
#include <string>

#include "common/bus/dds_bus.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/periodic.hpp"
#include "common/realtime/shutdown.hpp"

namespace {

using namespace palpate;

constexpr std::int64_t kSilence = 100'000'000;  // [ns] without a force, after which the motors go limp

/// An emulated device: goes in and out within four seconds, and remembers the largest force.
class Hardware {
 public:
  Hardware(double from, double to) : from_(from), to_(to) {}

  DeviceState read() const {
    DeviceState state;
    state.sense_ns = now_ns();
    const double seconds = 1e-9 * static_cast<double>(state.sense_ns - begin_ns_);
    state.depth = from_ + (to_ - from_) * 0.5 * (1 - std::cos(2 * std::numbers::pi * seconds / 4));
    return state;
  }
  void drive_motors(const ForceState& f) {
    largest_ = std::max(largest_, std::hypot(f.force[0], f.force[1], f.force[2]));
  }
  void go_limp() { std::puts("limp: no force for 100 ms"), std::fflush(stdout); }
  double largest() const { return largest_; }  ///< [N]

 private:
  double from_, to_;  // [m]
  std::int64_t begin_ns_ = now_ns();
  double largest_ = 0;
};

/// True if a force for this tool has come.
bool take_force(Reader<ForceState>& forces, std::uint32_t tool, Hardware& hardware) {
  bool heard = false;
  while (const auto force = forces.take()) {
    if (force->tool != tool) continue;
    hardware.drive_motors(*force);
    heard = true;
  }
  return heard;
}

void run(int domain, std::uint32_t tool, Hardware hardware) {
  catch_shutdown_signals();
  const auto bus = make_dds_bus({.domain = domain});
  const auto device = bus->writer(topics::device_state);
  const auto forces = bus->reader(topics::force_state);
  PeriodicTimer timer(1000, 0);
  bool limp = true;  // until the first force
  std::uint64_t seq = 0;
  for (std::int64_t heard_ns = now_ns(); !shutdown_requested(); timer.wait()) {
    DeviceState state = hardware.read();
    state.tool = tool;
    state.seq = ++seq;
    device->write(state);
    if (take_force(*forces, tool, hardware)) {
      heard_ns = now_ns();
      limp = false;
    } else if (!limp && now_ns() - heard_ns > kSilence) {
      hardware.go_limp();
      limp = true;
    }
  }
  std::printf("%llu samples, the largest force %.3f N\n", static_cast<unsigned long long>(seq), hardware.largest());
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const auto number = [&](int place, double otherwise) { return argc > place ? std::stod(argv[place]) : otherwise; };
    run(static_cast<int>(number(1, 0)), static_cast<std::uint32_t>(number(2, 0)),
        Hardware(number(3, 0.10), number(4, 0.12)));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "press: %s\n", error.what());
    return 1;
  }
  return 0;
}
