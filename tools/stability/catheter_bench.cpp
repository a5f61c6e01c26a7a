#include "tools/stability/catheter_bench.hpp"

#include <fmt/format.h>

#include "common/mesh/shell_generators.hpp"
#include "common/models/modal_shell/precompute.hpp"
#include "tools/stability/press_bench.hpp"

namespace palpate::stability {

void CatheterWatch::look(const CatheterBody& body) {
  for (const CatheterToolForce& f : body.tool_forces()) force_ = larger(force_, f.force.norm());
  for (const Eigen::Vector3d& x : body.positions()) reach_ = larger(reach_, x.norm());
}

Result CatheterWatch::result(double energy_growth) const {
  Result r{.max_force = force_,
           .energy_growth = energy_growth,
           .note = fmt::format("energy is the catheter's own; reach {:.3g} m", reach_)};
  if (!std::isfinite(force_) || !(reach_ <= 10)) r.outcome = Outcome::failed;
  return r;
}

Duct::Duct() {
  constexpr double radius = 0.0045, length = 0.04;
  const Scene scene = block_scene();
  ModalShellSpec duct;
  duct.name = "duct";
  duct.material = {.young = 200e3, .poisson = 0.45, .density = 1000};
  duct.shell = {.thickness = 0.001, .modes = 20};
  duct.fixed.push_back({{.where = {.indices = {}, .box = Box{{-1, -1, length - 1e-6}, {1, 1, 1}}, .group = {}}}});
  body_ = std::make_unique<ModalBody>(precompute(duct, make_tube(radius, length, 16, 16)), duct,
                                      StepSettings{scene.contact, scene.tools, 1 / scene.rates.haptic_hz});
}

void Duct::tick(CatheterBody& catheter, std::span<const Eigen::Isometry3d> jaws) {
  body_->update_surface({});
  catheter.step({}, jaws);
  body_->push(catheter.wall_forces());
  body_->collide({});
  body_->hold({});
}

}  // namespace palpate::stability
