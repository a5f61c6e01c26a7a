// The examples of drivers, built outside the tree against an installed palpate, on a real haptic node.
#include <atomic>
#include <csignal>

#include "common/realtime/clock.hpp"
#include "tests/drivers/driver_rig.hpp"
#include "tests/sanitized.hpp"

namespace palpate::testing {
namespace {

namespace fs = std::filesystem;

/// The program of the example in that language, which the test driver_examples of ctest builds.
std::string example_in(const std::string& language) {
  return fs::path(PALPATE_EXAMPLES) / language / "press";
}

const std::vector<std::string> kPress{"0", "0.18", "0.199"};

std::vector<std::string> with(std::vector<std::string> command, std::vector<std::string> before = {}) {
  command.insert(command.end(), before.begin(), before.end());
  command.insert(command.end(), kPress.begin(), kPress.end());
  return command;
}

TEST(Drivers, InCWithTheMiddlewareAndTheInstalledMessagesAlone) {
  DriverRig rig;
  const std::string network =
      fmt::format("{} network {} --domain {} 2>/dev/null", program("palpate"), rig.scene(), own_domain());
  expect_a_whole_driver(
      rig, with({"/bin/sh", "-c", "CYCLONEDDS_URI=\"$(" + network + ")\" exec \"$@\"", "sh", example_in("c")}));
}

TEST(Drivers, InCppWithTheInstalledLibrary) {
  DriverRig rig;
  expect_a_whole_driver(rig, with({example_in("cpp")}, {std::to_string(own_domain())}));
}

const fs::path kModule = fs::path(PALPATE_BUILD) / "python";

/// Null where it can be tried.
const char* why_not_in_python() {
  if (!fs::exists(kModule)) return "built without pybind11";
  return kSanitized ? "Python itself has no sanitizer, which the module needs" : nullptr;
}

/// A script of the source tree, in the domain of this process.
std::vector<std::string> python(const std::string& script) {
  return {"/usr/bin/env", "PYTHONPATH=" + kModule.string(), PALPATE_PYTHON3, PALPATE_SOURCE "/" + script,
          std::to_string(own_domain())};
}

TEST(Drivers, SayWhichArgumentIsWrong) {
  std::string said;
  for (const char* language : {"c", "cpp"}) {
    EXPECT_EQ(run_command(example_in(language) + " 12x", &said), 1);
    EXPECT_NE(said.find(" is a number from 0, and not '12x'"), std::string::npos) << said;
    EXPECT_EQ(run_command(example_in(language) + " 1 2 3 4 5", &said), 1);
    EXPECT_NE(said.find("press: too many arguments"), std::string::npos) << said;
  }
  if (why_not_in_python()) return;
  EXPECT_EQ(run_command(fmt::format("{} shallow", fmt::join(python("drivers/python/press.py"), " ")), &said), 1);
  EXPECT_NE(said.find("press: TOOL is a number from 0, and not 'shallow'"), std::string::npos) << said;
}

TEST(Drivers, InPythonWithItsModule) {
  if (const char* why = why_not_in_python()) GTEST_SKIP() << why;
  DriverRig rig;
  expect_a_whole_driver(rig, with(python("drivers/python/press.py")));
}

TEST(Drivers, InPythonAreRefusedWrongLimitsAndCountWhatWasSent) {
  if (const char* why = why_not_in_python()) GTEST_SKIP() << why;
  std::string said;
  EXPECT_EQ(run_command(fmt::format("{}", fmt::join(python("tests/python/device.py"), " ")), &said), 0) << said;
}

/// What a subscriber hears of a press from a signal to the haptic node on.
class EndedPress : public ::testing::TestWithParam<int> {};

TEST_P(EndedPress, TakesTheForceToZeroBeforeTheHapticNodeIsGone) {
  using namespace std::chrono_literals;
  DriverRig rig;
  std::atomic<bool> heard = false, over = false;
  std::thread hand([&] {
    const auto bus = make_dds_bus({.domain = own_domain()});
    const auto device = bus->writer(topics::device_state);
    for (DeviceState state{.seq = 1, .depth = 0.18}; !over; ++state.seq) {
      state.sense_ns = now_ns();
      if (heard) state.depth = std::min(state.depth + 2e-5, 0.2);
      device->write(state);
      std::this_thread::sleep_for(1ms);
    }
  });
  heard = rig.hear(20s, [](const ForceState&) { return true; });
  ForceState last;
  const bool pressed = rig.hear(20s, [&](const ForceState& f) { return last = f, newtons(f) > 0.42; });
  const double before = newtons(last);
  EXPECT_TRUE(pressed && rig.end(GetParam()));
  double change = 0;
  int steps = 0;
  const auto follow = [&](const ForceState& f) {
    double square = 0;
    for (int k = 0; k < 3; ++k) square += (f.force[k] - last.force[k]) * (f.force[k] - last.force[k]);
    if (f.step == last.step + 1) change = std::max(change, std::sqrt(square));
    last = f;
    ++steps;
    return false;
  };
  rig.hear(300ms, follow);
  over = true;
  hand.join();
  EXPECT_EQ(newtons(last), 0) << "the last force that anybody hears";
  EXPECT_LT(change, 0.15);
  fmt::print("{:.3f} N went in {} steps, by {:.4f} N in one at most\n", before, steps, change);
}

INSTANTIATE_TEST_SUITE_P(By, EndedPress, ::testing::Values(SIGINT, SIGTERM));

TEST(Drivers, TheNetworkThatIsPrintedIsTheScenes) {
  const LoopbackScene scene("network", kLinear);
  std::string said;
  EXPECT_EQ(run_command(fmt::format("(exec 2>/dev/null; {} network {} --domain 7)", program("palpate"), scene.scene()),
                        &said),
            0);
  EXPECT_EQ(said, dds_configuration({.domain = 7}) + "\n");
  EXPECT_NE(said.find("<Domain Id=\"7\">"), std::string::npos) << "who names no domain gets the scene's";
  EXPECT_EQ(run_command(fmt::format("{} network {} --interface nowhere0", program("palpate"), scene.scene()), &said),
            1);
  EXPECT_NE(said.find("no interface 'nowhere0'"), std::string::npos) << said;
}

}  // namespace
}  // namespace palpate::testing
