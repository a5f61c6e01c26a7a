// Catheters: stiffness, integrators, damping, and very many grasps.
#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <random>

#include "tools/rig/duct.hpp"
#include "tools/stability/watch.hpp"

namespace palpate::stability {
namespace {

using Eigen::Vector3d;

CatheterSettings settings(double young, ChainIntegrator integrator, double damping = 5) {
  CatheterSettings s;
  s.shape.tail = {0, 0, -0.12};
  s.shape.tip = {0, 0, 0};
  s.shape.particles = 41;
  s.shape.sleeve = 0.02;
  s.shape.damping = damping;
  s.shape.gravity = {0, -9.81, 0};
  s.shape.integrator = integrator;
  s.young = young;
  return s;
}

/// Takes the middle by a jaw, swings it to and fro, lets go, falls.
Result swing(const CatheterSettings& s, int ticks) {
  CatheterBody body(s, nullptr);
  CatheterWatch watch;
  double early = 0, late = 0;
  std::array jaw{Eigen::Isometry3d::Identity()};
  jaw[0].translation() = body.positions()[30];
  for (int i = 0; i < ticks; ++i) {
    if (i == ticks / 4) body.grasp(0, jaw[0], body.nearest(jaw[0].translation()), 0.004, 1e-4);
    if (i > ticks / 4) jaw[0].translation() += Vector3d(2e-4 * std::cos(0.03 * i), 0, 0);
    if (i < ticks / 4) jaw[0].translation() = body.positions()[30];
    if (i == ticks / 2) body.let_go(0);
    body.step({}, jaw);
    watch.look(body);
    double& most = i < 3 * ticks / 4 ? early : late;
    most = larger(most, body.energy());
  }
  return watch.result(larger(late - early, 0));
}

/// Grasps wherever chance has it: alone, or half led into a duct, drawn to and fro.
Result many_grasps(int grasps, bool in_duct) {
  std::optional<Duct> duct;
  CatheterSettings s = settings(3e7, ChainIntegrator::implicit);
  if (in_duct) {
    duct.emplace();
    s.shape.tail = {0, 0, -0.08};
    s.shape.tip = {0, 0, 0.02};
    s.shape.inside = "duct";
    s.shape.damping = 100;
  }
  CatheterBody body(s, duct ? &duct->wall() : nullptr);
  CatheterWatch watch;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  std::array<Eigen::Isometry3d, 2> jaws{Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity()};
  double deepest = 0, wall_energy = 0;
  long touches = 0;
  for (int g = 0; g < grasps; ++g) {
    const int tool = g % 2;
    const Vector3d hand =
        2e-3 * Vector3d(any(random), any(random), 2 * any(random));  // a few millimetres, mostly along it
    jaws[tool].translation() =
        body.positions()[10 + random() % 18] + 1e-3 * Vector3d(any(random), any(random), any(random));
    body.grasp(tool, jaws[tool], body.nearest(jaws[tool].translation()), 0.004 * (g % 3), 1e-4);
    for (int i = 0; i < 3; ++i) {
      jaws[tool].translation() += 0.1 * hand;
      duct ? duct->tick(body, jaws) : body.step({}, jaws);
      watch.look(body);
      touches += body.wall_contacts();
      deepest = larger(deepest, body.inserted());
      if (duct) wall_energy = larger(wall_energy, duct->energy());
    }
    if (random() % 4) body.let_go(tool);
  }
  Result r = watch.result(0);
  if (!duct) return r;
  r.note += fmt::format("; {} touches of the wall, {:.3g} mm led in at most, {:.3g} mJ in the wall at most", touches,
                        1e3 * deepest, 1e3 * wall_energy);
  if (!(wall_energy < 1)) r.outcome = Outcome::failed;
  return r;
}

}  // namespace

std::vector<Point> catheter_points(const Extent& extent) {
  std::vector<Point> points;
  const int ticks = extent.quick ? 400 : 4000;
  for (const ChainIntegrator integrator : {ChainIntegrator::implicit, ChainIntegrator::semi_implicit}) {
    for (double e :
         extent.quick ? std::vector{1e3, 1e12} : std::vector{1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12})
      points.push_back({fmt::format("catheter {}", word_of(integrator)), "E [Pa]", fmt::format("{:g}", e),
                        [=] { return swing(settings(e, integrator), ticks); }});
    for (double d : extent.quick ? std::vector{1e5} : std::vector{0.0, 1.0, 1e3, 1e5})
      points.push_back({fmt::format("catheter {}", word_of(integrator)), "damping [1/s]", fmt::format("{:g}", d),
                        [=] { return swing(settings(1e6, integrator, d), ticks); }});
    for (double h : extent.quick ? std::vector{1e-2} : std::vector{1e-7, 1e-5, 1e-3, 1e-2, 1e-1})
      points.push_back({fmt::format("catheter {}", word_of(integrator)), "tick [s]", fmt::format("{:g}", h), [=] {
                          CatheterSettings s = settings(1e6, integrator);
                          s.step = h;
                          return swing(s, ticks);
                        }});
  }
  const int grasps = extent.quick ? 1000 : 100000;
  for (const bool in_duct : {false, true})
    points.push_back({in_duct ? "grasps in a duct" : "grasps", "number", std::to_string(grasps),
                      [=] { return many_grasps(grasps, in_duct); }, 600});
  return points;
}

}  // namespace palpate::stability
