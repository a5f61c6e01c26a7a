#include "tools/stability/organ_bench.hpp"

#include <algorithm>
#include <cmath>

#include "common/mesh/generators.hpp"

namespace palpate::stability {

using Eigen::Vector3d;

OrganBench::OrganBench(Scene scene, std::vector<Archive> archives)
    : scene_(std::move(scene)), archives_(std::move(archives)), world_(scene_, archives_) {}

void OrganBench::tick(const Vector3d& p, double pedal, double grip) {
  const Tool& tool = scene_.tools[0];
  const ToolDofs d = dofs_for_tip(make_trocar(tool.pivot, tool.axis, tool.up), p, 0);
  ToolState s{.run = 7,
              .step = ++step_,
              .sense_ns = static_cast<std::int64_t>(step_),
              .yaw = d.yaw,
              .pitch = d.pitch,
              .depth = d.depth,
              .roll = 0,
              .grip = grip};
  s.pedal = pedal;
  const ProbeSpec* probe = tool.probe();
  s.holding = probe && probe->jaws && grip < probe->jaws->closed_below;
  world_.take(s);
  world_.tick();
  Vector3d force = Vector3d::Zero();
  for (const TouchContact& c : organ().contacts()) force += c.force;
  for (const Vector3d& x : organ().surface().positions()) {
    reach_ = larger(reach_, x.norm());
  }
  largest_ = larger(largest_, force.norm());
  double& most = step_ <= 200 ? first_energy_ : late_energy_;
  most = larger(most, organ().model().energy());
}

Result OrganBench::result() const {
  Result r{.max_force = largest_,
           .energy_growth = larger(late_energy_ - first_energy_, 0),
           .note = "energy is the tissue's own"};
  if (!(reach_ <= 1e3)) r = {.outcome = Outcome::failed, .note = "the tissue's shape is not a number or runs away"};
  return r;
}

Scene organ_scene(Body body) {
  MovingSpec& tissue = *as<MovingSpec>(body);
  tissue.name = "block";
  tissue.material = {.young = 5000, .poisson = 0.4, .density = 1000};
  tissue.fixed.push_back({.where = {.indices = {}, .box = {}, .group = "bottom"}});
  tissue.dynamic.damping = 60;
  Scene scene;
  scene.bodies.push_back(std::move(body));
  Tool tool;
  tool.name = "probe";
  tool.pivot = {0, 0, 0.3};
  tool.probe()->radius = 0.006;
  tool.shaft_length = 0.01;
  scene.tools.push_back(tool);
  return scene;
}

TetMesh organ_mesh(int cells) {
  return make_block({-0.02, -0.02, 0}, {0.02, 0.02, 0.02}, {cells, cells, std::max(1, cells / 2)});
}

Result press_organ(const Scene& scene, const TetMesh& mesh, double depth, int ticks) {
  OrganBench bench(scene, {precompute_tissue(scene.bodies[0], mesh)});
  const double high = 0.02 + 0.0061, low = 0.026 - depth;
  for (int i = 0; i < ticks; ++i) {
    const double share = std::min(1.0, 2.0 * std::min(i, ticks - i) / ticks * 2);
    bench.tick({0, 0, high - share * (high - low)});
  }
  return bench.result();
}

}  // namespace palpate::stability
