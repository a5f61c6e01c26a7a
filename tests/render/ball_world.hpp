#pragma once
#include "common/bus/memory_bus.hpp"
#include "common/bus/presence.hpp"
#include "common/realtime/clock.hpp"
#include "render_node/stage.hpp"
#include "tests/render/scenery.hpp"

namespace palpate::testing {

/// A ball about a place as body, one tool above it, and a haptic node with run 5 on the same bus.
struct BallWorld {
  std::shared_ptr<MemoryNetwork> network = make_memory_network();
  std::unique_ptr<Bus> haptic_bus = make_memory_bus(network), bus = make_memory_bus(network);
  Presence haptic{*haptic_bus, "haptic", 5, "scene", "archive"};
  Presence presence{*bus, "render", 0, "scene", "archive"};
  Scene scene;
  Archive archive;

  /// `at`: [m] the ball's middle.
  explicit BallWorld(const Eigen::Vector3d& at = Eigen::Vector3d::Zero()) {
    const Ball ball = make_ball(0.05f, 6);
    scene.title = "a ball";
    scene.bodies.resize(1);
    scene.tools.resize(1);
    scene.tools[0].name = "probe";
    scene.tools[0].pivot = at + Eigen::Vector3d(0, 0, 0.2);
    scene.rates.visual_hz = 50;
    scene.render = Render{.width = 160, .height = 120, .camera = empty_frame().camera};
    scene.render->camera.eye += at;
    scene.render->camera.target += at;
    archive.young = {1e4};
    archive.poisson = {0.3};
    for (const auto& p : ball.position) archive.surface.position.push_back(at + p.cast<double>());
    archive.surface.triangles = ball.triangles;
    const int n = archive.surface.size();
    archive.surface.touchable = n;
    archive.surface.fixed.resize(n);
    for (int i = 0; i < n; ++i) archive.surface.node_number.push_back(i);
    for (int dof = 0; dof < 3 * n; ++dof) {
      archive.touchable_dofs.push_back({dof / 3, dof % 3});
      for (int j = 0; j <= dof; ++j) archive.touchable_compliance.push_back(dof == j ? 1e-3 : 0);  // springs of 1 N/mm
    }
    presence.watch();
  }

  Stage stage() const { return Stage(scene, std::span(&archive.surface, 1), {}); }
  std::vector<std::size_t> nodes() const { return {archive.surface.position.size()}; }

  ContactState press(int node, double newton, std::uint64_t run = 5) const {
    ContactState contacts;
    contacts.run = run;
    contacts.sense_ns = now_ns();
    contacts.step = 1;
    contacts.press = {0, 1, 0};
    contacts.forces.push_back({0, static_cast<std::uint32_t>(node), {0, newton, 0}});
    return contacts;
  }
};

}  // namespace palpate::testing
