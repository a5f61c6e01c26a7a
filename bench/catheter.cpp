// Time of one tick of the catheter over particles, modes of the wall and inserted length.
#include "bench/only.hpp"
#include "bench/report.hpp"
#include "common/models/catheter/catheter_body.hpp"
#include "tests/catheter/tube_wall.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kLength = 0.18, kDuct = 0.16;  // [m]

/// A catheter that lies on the floor of a soft duct with `inside` of its length [m]; the rest sticks out of
/// the mouth.
CatheterSettings lying(int particles, double inside) {
  CatheterSettings s;
  s.shape.particles = particles;
  s.shape.tip = {0.2e-3, -2.7e-3, inside};
  s.shape.tail = s.shape.tip - Vector3d(0, 0, kLength);
  s.shape.gravity = {0, -9.81, 0};
  s.young = 1e7;
  return s;
}

void measure(const std::string& name, int particles, int modes, double inside, int count) {
  TubeWall wall({.length = kDuct, .around = 24, .rings = 137, .twisted = false, .modes = modes, .residual = 0.01});
  CatheterBody body(lying(particles, inside), &wall);
  const ChainPoint held = body.nearest({0, 0, -0.01});
  Eigen::Isometry3d jaw = Eigen::Isometry3d::Identity();
  jaw.translation() = body.place(held);
  body.grasp(0, jaw, held, 6e-3, 1e-4);
  bench::Samples samples;
  double iterations = 0, passes = 0, touching = 0;
  for (int i = -300; i < count; ++i) {
    jaw.translation().z() += 1e-6 * (i % 400 < 200 ? 1 : -1);  // to and fro
    if (i >= 0)
      samples.measure(0, 1, [&](int) { body.step({}, {&jaw, 1}); });
    else
      body.step({}, {&jaw, 1});
    iterations += body.effort().iterations;
    passes += body.effort().passes;
    touching += body.wall_contacts();
    wall.advance(body.wall_forces());
  }
  const double all = count + 300;
  bench::report("catheter_step", name, "p50", samples.median() * 1e6, "us");
  bench::report("catheter_step", name, "p99", samples.p99() * 1e6, "us");
  bench::report("catheter_step", name, "touching", touching / all, "1");
  bench::report("catheter_step", name, "passes", passes / all, "1");
  bench::report("catheter_step", name, "iterations", iterations / all, "1");
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  const int count = palpate::bench::quick(argc, argv) ? 400 : 3000;
  const auto measure = [&](const std::string& name, int particles, int modes, double inside) {
    if (palpate::bench::is_asked_for(name, argc, argv)) palpate::measure(name, particles, modes, inside, count);
  };
  measure("reference", 60, 50, 0.09);
  for (const int particles : {20, 40, 60, 120, 240})
    measure(fmt::format("particles{}", particles), particles, 50, 0.09);
  for (const int modes : {0, 10, 20, 50, 100, 200}) measure(fmt::format("modes{}", modes), 60, modes, 0.09);
  for (const int depth : {0, 30, 60, 90, 120, 150}) measure(fmt::format("inserted_mm{}", depth), 60, 50, 1e-3 * depth);
}
