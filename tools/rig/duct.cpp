#include "tools/rig/duct.hpp"

#include <chrono>

#include "common/mesh/shell_generators.hpp"
#include "common/models/modal_shell/precompute.hpp"
#include "tools/rig/example_bodies.hpp"

namespace palpate {

double tick_in_duct(CatheterBody& catheter, ModalBody& duct, std::span<const Eigen::Isometry3d> jaws) {
  duct.update_surface({});
  const auto begin = std::chrono::steady_clock::now();
  catheter.step({}, jaws);
  const auto end = std::chrono::steady_clock::now();
  duct.push(catheter.wall_forces());
  duct.collide({});
  duct.hold({});
  return std::chrono::duration<double>(end - begin).count();
}

Duct::Duct() {
  const Scene scene = block_scene();
  const ModalShellSpec duct = duct_body();
  body_ = std::make_unique<ModalBody>(precompute(duct, make_tube(kDuctRadius, kDuctLength, 16, 16)), duct,
                                      StepSettings{scene.contact, scene.tools, 1 / scene.rates.haptic_hz});
}

}  // namespace palpate
