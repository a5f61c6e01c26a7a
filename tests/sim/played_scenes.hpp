#pragma once
#include <cmath>
#include <functional>
#include <numbers>

#include "common/scene/find_archive.hpp"
#include "common/sim/simulator.hpp"
#include "tests/deform/block_bench.hpp"
#include "tests/haptic/block_scene.hpp"
#include "tests/haptic/duct_scene.hpp"

/// Small scenes with a motion of their tools, one for each way in which tissue is computed.
namespace palpate::testing {

struct PlayedScene {
  const char* name;
  Scene scene;
  std::vector<Archive> archives;
  std::function<std::vector<sim::ToolInput>(int)> inputs;  ///< of step i = 0, 1, ...; step 0 is where it starts
};

/// A probe presses the block at z = 0 and slides.
inline PlayedScene pressed_block() {
  BlockScene block(1, 6);
  const Tool tool = block.scene.tools[0];
  return {"pressed_block", block.scene, block.archives, [tool](int i) -> std::vector<sim::ToolInput> {
            const double down = 0.002 - 0.006 * std::sin(0.01 * i);
            return {{tip_at(tool, {2e-5 * i, 0, 0.008 + down})}};
          }};
}

/// The same of tissue that relaxes, under a patch of the tip's own.
inline PlayedScene relaxing_block() {
  PlayedScene played = pressed_block();
  played.name = "relaxing_block";
  played.scene.contact.rule = ContactRule::patch;
  as<QuasiStaticSpec>(played.scene.bodies[0])->relaxation = Relaxation{{0.02, 0.3}, {0.3, 0.3}};
  return played;
}

/// Moving tissue, 30 mm high: pressed, and cut while the pedal is down.
template <class Spec = TensorMassSpec>
PlayedScene cut_block() {
  Spec body;
  if constexpr (std::same_as<Spec, HybridSpec>) {
    ElementSelector right;
    right.box = Box{{-0.001, -0.031, -0.001}, {0.031, 0.031, 0.031}};
    body.hybrid.regions.push_back(right);
  }
  Scene scene = block_scene(body);
  std::get<ProbeSpec>(scene.tools[0].end).cautery = Cautery{.radius = 0.006};
  const TetMesh mesh = middle_block_mesh(6);
  std::vector<Archive> archives{precompute_on(scene.bodies[0], mesh)};
  const Tool tool = scene.tools[0];
  return {"cut_block", scene, archives, [tool](int i) -> std::vector<sim::ToolInput> {
            const double down = 0.001 - 0.004 * std::sin(0.01 * i);
            ToolDofs dofs = tip_at(tool, {-0.01 + 3e-5 * i, 0, 0.036 + down});
            dofs.pedal = i >= 200 && i < 260;
            return {{dofs}};
          }};
}

/// A forceps takes a catheter, leads it into a duct, and bends it against the wall.
inline PlayedScene fed_catheter() {
  DuctScene duct;
  duct.add_forceps();
  duct.add_catheter();
  duct.archives[1] = find_archive(duct.scene, duct.scene.bodies[1], ArchivePart::surface);
  const Tool tool = duct.scene.tools[0];
  return {"fed_catheter", duct.scene, duct.archives, [tool](int i) -> std::vector<sim::ToolInput> {
            const auto part = [i](int begin, int end) { return std::clamp((i - begin) / double(end - begin), 0., 1.); };
            const Eigen::Vector3d joint(0.004 * part(450, 600), 0.03 - 0.022 * part(0, 150),
                                        -0.02 + 0.015 * part(250, 450));
            return {{duct_tip_at(tool, joint, 0.8 - 0.7 * part(150, 250), std::numbers::pi / 2)}};
          }};
}

}  // namespace palpate::testing
