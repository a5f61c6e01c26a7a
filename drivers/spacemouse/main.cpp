// palpate_spacemouse: moves a tool whose device is "bus" by a SpaceMouse, which spacenavd reads.
#include <fmt/format.h>
#include <spnav.h>
#include <sys/socket.h>

#include <stdexcept>

#include "common/node/node_setup.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/periodic.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/scene/scene_changes.hpp"
#include "drivers/spacemouse/cap_motion.hpp"

namespace palpate {
namespace {

struct MouseOptions : NodeOptions {
  std::string tool;
  double depth = 0;
  CapSpeeds speeds;
} options;

/// spacenavd's connection, as long as this lives.
class Mouse {
 public:
  Mouse() {
    if (spnav_open() < 0) throw std::runtime_error("spacenavd does not answer: is it running (Debian's spacenavd)?");
  }
  ~Mouse() { spnav_close(); }
  Mouse(const Mouse&) = delete;

  /// Passes on what has come. Throws std::runtime_error once spacenavd is gone.
  void take(CapMotion& motion) {
    spnav_event event;
    while (spnav_poll_event(&event) != 0) {
      const auto& m = event.motion;
      if (event.type == SPNAV_EVENT_MOTION) motion.push({m.x, m.y, m.z, m.rx, m.ry, m.rz});
      if (event.type == SPNAV_EVENT_BUTTON) motion.press(event.button.bnum, event.button.press != 0);
    }
    char byte;
    if (recv(spnav_fd(), &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0) throw std::runtime_error("spacenavd has ended");
  }
};

std::uint32_t tool_number(const Scene& scene, const std::string& name) {
  for (std::size_t t = 0; t < scene.tools.size(); ++t)
    if (scene.tools[t].name == name || (name.empty() && scene.tools.size() == 1)) return static_cast<std::uint32_t>(t);
  throw std::runtime_error(name.empty()
                               ? fmt::format("the scene has {} tools: name one with --tool", scene.tools.size())
                               : fmt::format("the scene has no tool '{}'", name));
}

void run(const NodeOptions&) {
  const Scene scene = load_scene(options.scene, parse_changes(options.set));
  DeviceState state{.tool = tool_number(scene, options.tool)};
  Mouse mouse;
  const auto bus = make_dds_bus(bus_settings(scene, options, "driver"));
  const auto device = bus->writer(topics::device_state);
  CapMotion motion({.depth = options.depth}, options.speeds);
  catch_shutdown_signals();
  constexpr double rate_hz = 1000;
  PeriodicTimer timer(rate_hz, 0);
  const std::int64_t begin = now_ns();
  const auto over = [&] {
    return options.seconds > 0 && 1e-9 * static_cast<double>(now_ns() - begin) > options.seconds;
  };
  for (; !shutdown_requested() && !over(); timer.wait()) {
    state.sense_ns = now_ns();
    mouse.take(motion);
    const ToolDofs& dofs = motion.step(1 / rate_hz);
    state.seq++;
    state.yaw = dofs.yaw, state.pitch = dofs.pitch, state.depth = dofs.depth;
    state.roll = dofs.roll, state.grip = dofs.grip, state.pedal = dofs.pedal;
    state.publish_ns = 0;
    device->write(state);
  }
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  using namespace palpate;
  cli::CommandLine app{"palpate_spacemouse: moves a tool whose device is \"bus\" by a SpaceMouse, through spacenavd"};
  add_node_options(app, options);
  app.add_option("--tool", options.tool, "Its name, where the scene has several");
  app.add_option("--depth", options.depth, "Of the tip beyond the trocar at the beginning [m]")
      .between(0.0, 1.0)
      .show_default();
  app.add_option("--speed", options.speeds.tip, "Of the tip while the cap is pushed all the way [m/s]")
      .between(0.001, 0.5)
      .show_default();
  app.examples({"palpate_spacemouse scene.toml --depth 0.1", "palpate_spacemouse scene.toml --tool probe --peer HOST"});
  return node_main("palpate_spacemouse", argc, argv, app, run, options);
}
