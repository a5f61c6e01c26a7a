// palpate_spacemouse on a socket that speaks as spacenavd does.
#include <sys/socket.h>
#include <sys/un.h>

#include <csignal>

#include "drivers/spacemouse/cap_motion.hpp"
#include "tests/drivers/driver_rig.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;

TEST(CapMotionTest, ATiltMovesTheTipAtItsSpeedAndRestKeepsItsPlace) {
  CapMotion motion({.depth = 0.1}, {.tip = 0.05});
  motion.push({0, -CapMotion::kFull, 0, 0, 0, 0});
  for (int i = 0; i < 1000; ++i) motion.step(0.001);
  motion.push({});
  EXPECT_NEAR(motion.step(0.001).depth, 0.15, 1e-9) << "down: in along the shaft";
  motion.push({CapMotion::kFull / 2, 0, 2 * CapMotion::kFull, 0, CapMotion::kFull, 0});
  const ToolDofs dofs = motion.step(0.03);
  EXPECT_NEAR(0.15 * dofs.yaw, 0.5 * 0.05 * 0.03, 1e-9);
  EXPECT_NEAR(0.15 * dofs.pitch, -0.05 * 0.03, 1e-9) << "no axis counts for more than all the way";
  EXPECT_NEAR(dofs.roll, 1.5 * 0.03, 1e-9);
}

TEST(CapMotionTest, NoPushLeadsOutOfTheTrocarsRange) {
  CapMotion motion({}, {});
  motion.push({-CapMotion::kFull, CapMotion::kFull, 0, 0, 0, 0});
  for (int i = 0; i < 100'000; ++i) motion.step(0.001);
  EXPECT_EQ(motion.step(0.001).depth, 0);
  EXPECT_GE(motion.step(0.001).yaw, -1.4);
}

TEST(CapMotionTest, ButtonsArePedalAndJaws) {
  CapMotion motion({}, {.jaws = 1});
  motion.press(0, true);
  for (int i = 0; i < 500; ++i) motion.step(0.001);
  EXPECT_EQ(motion.step(0.001).pedal, 1);
  EXPECT_NEAR(motion.step(0.001).grip, 0.502, 1e-9) << "they open by themselves";
  motion.press(1, true), motion.press(0, false);
  for (int i = 0; i < 600; ++i) motion.step(0.001);
  EXPECT_EQ(motion.step(0.001).grip, 0);
  EXPECT_EQ(motion.step(0.001).pedal, 0);
}

/// The daemon's end: a UNIX socket, on which each event is eight 32-bit numbers.
class Daemon {
 public:
  Daemon() : path_(std::filesystem::temp_directory_path() / fmt::format("palpate-spnav-{}.sock", getpid())) {
    std::filesystem::remove(path_);
    sockaddr_un address{.sun_family = AF_UNIX};
    path_.string().copy(address.sun_path, sizeof address.sun_path - 1);
    listener_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 || listen(listener_, 1) != 0)
      throw std::runtime_error("no socket at " + path_.string());
  }
  ~Daemon() {
    end();
    close(listener_);
    std::filesystem::remove(path_);
  }
  std::string path() const { return path_; }
  void meet() { connection_ = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC); }
  void push(int right, int up, int away) { tell({0, right, up, away, 0, 0, 0, 16}); }
  void press(int button) { tell({1, button, 0, 0, 0, 0, 0, 0}); }
  void end() {
    if (connection_ >= 0) close(connection_);
    connection_ = -1;
  }

 private:
  void tell(const std::array<std::int32_t, 8>& event) {
    ASSERT_EQ(send(connection_, event.data(), sizeof event, MSG_NOSIGNAL), static_cast<ssize_t>(sizeof event));
  }
  std::filesystem::path path_;
  int listener_, connection_ = -1;
};

TEST(SpaceMouse, PressesTheTissueAndLetsGoOnceItsDaemonIsGone) {
  DriverRig rig;
  Daemon daemon;
  ChildProcess driver("palpate_spacemouse",
                      {"/usr/bin/env", "SPNAV_SOCKET=" + daemon.path(), program("palpate_spacemouse"), rig.scene(),
                       "--depth", "0.17", "--domain", std::to_string(own_domain())});
  daemon.meet();
  ASSERT_TRUE(rig.hear(20s, [](const ForceState&) { return true; })) << "the tool stands where it begins";
  daemon.push(0, -CapMotion::kFull, 0);
  EXPECT_TRUE(rig.hear(5s, [](const ForceState& f) { return newtons(f) > 0.2; })) << "the cap is pushed down";
  daemon.push(0, 0, 0);
  EXPECT_FALSE(rig.hear(500ms, [](const ForceState& f) { return newtons(f) == 0; })) << "the tool stays pressed";
  daemon.end();
  ASSERT_TRUE(driver.wait(10s)) << "it ends with its daemon";
  EXPECT_EQ(driver.status(), 1);
  EXPECT_TRUE(rig.hear(10s, [](const ForceState& f) { return (f.flags & silent_device) && newtons(f) == 0; }));
}

TEST(SpaceMouse, SaysWhatIsMissing) {
  const LoopbackScene scene("spacemouse", kLinear);
  std::string said;
  EXPECT_EQ(run_command("SPNAV_SOCKET=/nonexistent " + program("palpate_spacemouse") + " " + scene.scene(), &said), 1);
  EXPECT_NE(said.find("spacenavd does not answer"), std::string::npos) << said;
  EXPECT_EQ(run_command(program("palpate_spacemouse") + " " + scene.scene() + " --tool pen", &said), 1);
  EXPECT_NE(said.find("no tool 'pen'"), std::string::npos) << said;
}

}  // namespace
}  // namespace palpate::testing
