// A driver in C++: publishes a tool's position a thousand times a second and takes the force for the motors.
//   press DOMAIN [TOOL [FROM TO]]
// DOMAIN: of the running system on this host. TOOL: its place in the scene's list, from 0. FROM, TO: depths beyond the
// trocar [m], between which the emulated hardware goes in and out. For hardware of your own, replace Hardware.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <exception>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>

#include "common/bus/dds_bus.hpp"
#include "common/bus/force_follower.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/periodic.hpp"
#include "common/realtime/shutdown.hpp"

namespace {

using namespace palpate;

/// What the emulated device's motors give.
constexpr MotorLimits kLimits{.max_force = 10, .max_torque = 3, .max_grip = 1, .max_force_rate = 500};

/// An emulated device: goes in and out within four seconds, and remembers the largest force and change.
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
  void drive_motors(const MotorForce& now) {
    const auto& f = now.force;
    largest_ = std::max(largest_, std::hypot(f[0], f[1], f[2]));
    change_ = std::max(change_, std::hypot(f[0] - force_[0], f[1] - force_[1], f[2] - force_[2]));
    force_ = f;
  }
  double largest() const { return largest_; }  ///< [N]
  double change() const { return change_; }    ///< [N] from one tick to the next

 private:
  double from_, to_;  // [m]
  std::int64_t begin_ns_ = now_ns();
  std::array<double, 3> force_{};
  double largest_ = 0, change_ = 0;
};

/// Says it whenever the motors go limp.
void say_limp(bool limp, bool& said) {
  if (limp && !said) std::puts("limp: no force for 40 ms"), std::fflush(stdout);
  said = limp;
}

void run(int domain, std::uint32_t tool, Hardware hardware) {
  catch_shutdown_signals();
  const auto bus = make_dds_bus({.domain = domain});
  const auto device = bus->writer(topics::device_state);
  const auto forces = bus->reader(topics::force_state, Keep::all);  // another's cannot hide those that are followed
  ForceFollower follower(tool, kLimits);
  PeriodicTimer timer(1000, 0);
  bool limp = true;  // until the first force
  DeviceState state;
  for (std::uint64_t seq = 0; !shutdown_requested(); timer.wait()) {
    state = hardware.read();
    state.tool = tool;
    state.seq = ++seq;
    device->write(state);
    while (const auto force = forces->take()) follower.hear(*force, now_ns());
    hardware.drive_motors(follower.give(now_ns()));
    say_limp(follower.limp(), limp);
  }
  for (; !follower.limp(); timer.wait()) hardware.drive_motors(follower.give(now_ns()));  // no kick at the end
  std::printf("%llu samples, the largest force %.3f N, the largest change %.3f N\n",
              static_cast<unsigned long long>(state.seq), hardware.largest(), hardware.change());
  std::printf("not felt: %llu forces of another run, %llu out of range\n",
              static_cast<unsigned long long>(follower.strange()), static_cast<unsigned long long>(follower.refused()));
}

/// The whole argument at a place as a number, or what stands for it where there is none.
template <class T>
T number(int argc, char** argv, int place, const char* name, T otherwise) {
  if (argc <= place) return otherwise;
  const std::string_view text = argv[place];
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0 || value > T(1e9))
    throw std::invalid_argument(std::string(name) + " is a number from 0, and not '" + argv[place] + "'");
  return value;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc > 5) throw std::invalid_argument("too many arguments: press DOMAIN [TOOL [FROM TO]]");
    const int domain = number(argc, argv, 1, "DOMAIN", 0), tool = number(argc, argv, 2, "TOOL", 0);
    run(domain, static_cast<std::uint32_t>(tool),
        Hardware(number(argc, argv, 3, "FROM", 0.10), number(argc, argv, 4, "TO", 0.12)));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "press: %s\n", error.what());
    return 1;
  }
  return 0;
}
