#include "tools/stability/moving_press.hpp"

#include <algorithm>
#include <cmath>

#include "common/mesh/generators.hpp"
#include "common/models/moving/tried_contact.hpp"
#include "tools/rig/example_bodies.hpp"
#include "tools/rig/kinds.hpp"
#include "tools/rig/press_rig.hpp"
#include "tools/stability/press.hpp"
#include "tools/stability/stand_judge.hpp"
#include "tools/stability/watch.hpp"

namespace palpate::stability {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;    // [s]
constexpr double kPivot = 1e3;    // [m] from the tissue: all of a tool so long moves as its tip does
constexpr double kBeyond = 0.75;  // [1] of the block, from its middle: there a shaft ends
constexpr double kStabSpeed = TriedContact::kMaxSpeed, kSlideSpeed = 0.02;  // [m/s]
constexpr double kStand = 1;         // [s] of standing before nothing but chatter is left
constexpr double kDecay = 8;         // [1] time constants that slow tissue is given to come to rest
constexpr double kSlowSwing = 0.02;  // [s] period from which it swings on after the press

struct Stroke {
  Path path;
  int ticks;  // until it stands
};

double smooth(double t) {
  const double x = std::clamp(t, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

double length_of(const MovingPress& p) {
  return p.cells.x() * p.cell.x();
}

/// [m] From the middle, along x.
double place_along(const MovingPress& p) {
  if (p.shaft) return kBeyond * length_of(p);
  if (p.from_rim) return 0.5 * length_of(p) - *p.from_rim * p.radius;
  return p.beside.x() * p.cell.x();
}

/// The tip's centre, as the gesture leads it.
Stroke stroke_of(const MovingPress& p) {
  const Vector3d place = p.origin + Vector3d(place_along(p), p.beside.y() * p.cell.y(), p.radius);
  const double above = 0.1 * p.depth, way = p.depth + above, slide = (p.from_rim ? -0.5 : 0.5) * p.cell.x();
  const auto at = [=](double share, double along = 0) -> Vector3d {
    return place + Vector3d(p.shaft ? 0 : along, p.shaft ? along : 0, above - share * way);
  };
  if (p.gesture == "stabbed") {
    const int ticks = std::max(1, static_cast<int>(std::ceil(way / kStabSpeed / kTick)));
    return {[=](int i) { return at(std::min(1.0, static_cast<double>(i) / ticks)); }, ticks};
  }
  if (p.gesture == "tapped") {
    constexpr int kTap = 100, kTaps = 5;
    return {[=](int i) {
              if (i >= kTaps * kTap) return at(smooth((i - kTaps * kTap) / 200.0));
              return at(0.5 * (1 - std::cos(2 * M_PI * (i % kTap) / kTap)));
            },
            kTaps * kTap + 200};
  }
  const int down = 200, across = p.gesture == "slid" ? static_cast<int>(std::abs(slide) / kSlideSpeed / kTick) + 1 : 0;
  return {[=](int i) {
            return at(smooth(i / static_cast<double>(down)),
                      across ? slide * smooth((i - down) / static_cast<double>(across)) : 0);
          },
          down + across};
}

Scene scene_of(const MovingPress& p) {
  TensorMassSpec body = block_body<TensorMassSpec>({}, p.poisson);
  body.material.young = p.young;
  body.material.density = p.density;
  body.dynamic.damping = p.damping;
  body.dynamic.integrator = p.integrator;
  body.dynamic.precision = p.precision;
  body.dynamic.corotational = p.corotational;
  body.dynamic.element = p.element;
  Scene scene = scene_of_moving(body);
  scene.contact.friction = p.friction;
  scene.contact.rule = p.rule;
  scene.passivity.controller = false;
  Tool& tool = scene.tools[0];
  if (p.shaft) {
    tool.pivot = p.origin - Vector3d(kPivot, 0, 0);
    tool.axis = Vector3d::UnitX();
    tool.up = Vector3d::UnitZ();
    tool.shaft_radius = p.radius;
    tool.shaft_length = 2 * kBeyond * length_of(p);
    std::get<ProbeSpec>(tool.end).radius = 0.1 * p.radius;
  } else {
    tool.pivot = p.origin + Vector3d(0, 0, kPivot);
    std::get<ProbeSpec>(tool.end).radius = p.radius;
    tool.shaft_length = 0;
  }
  tool.max_force = 1e12;
  tool.max_force_rate = 1e15;
  return scene;
}

TetMesh mesh_of(const MovingPress& p) {
  const Vector3d size = p.cells.cast<double>().cwiseProduct(p.cell);
  return make_block(p.origin + Vector3d(-0.5 * size.x(), -0.5 * size.y(), -size.z()),
                    p.origin + Vector3d(0.5 * size.x(), 0.5 * size.y(), 0), {p.cells.x(), p.cells.y(), p.cells.z()});
}

/// [N] of the same contact with tissue of the same elements without inertia, at the end of the path.
double static_force(Scene scene, const TetMesh& mesh, const Archive& moving, const Stroke& stroke) {
  auto body = as_kind<QuasiStaticSpec>(scene.bodies[0]);
  body.offline = Offline{.element = FiniteElement::p1};
  scene.bodies[0] = body;
  Archive archive = precompute_on(scene.bodies[0], mesh);
  archive.touchable_compliance = moving.moving_compliance;
  PressRig rig(scene, {archive});
  rig.start(stroke.path(0));
  for (int i = 1; i <= stroke.ticks + 50; ++i) rig.press(stroke.path(i));
  return -rig.force().z();
}

/// Until the slowest motion, in shear, has died away: it swings, or creeps where the damping is strong.
int standing_ticks(const MovingPress& p) {
  const double shear_modulus = p.young / (2 * (1 + p.poisson)), height = p.cells.z() * p.cell.z();
  const double frequency = 0.5 * M_PI / height * std::sqrt(shear_modulus / p.density);
  const double rate = std::min(0.5 * p.damping, frequency * frequency / p.damping);
  const double rest = 2 * M_PI / frequency > kSlowSwing ? kDecay / rate : 0;
  return static_cast<int>((kStand + rest) / kTick);
}

}  // namespace

Result press_moving(const MovingPress& p) {
  const Scene scene = scene_of(p);
  const TetMesh mesh = mesh_of(p);
  const Stroke stroke = stroke_of(p);
  const Archive archive = precompute_on(scene.bodies[0], mesh);
  PressRig rig(scene, {archive});
  StandJudge judge;
  rig.press(stroke.path(0));
  for (int i = 1; i <= stroke.ticks + standing_ticks(p); ++i) {
    rig.press(stroke.path(i));
    judge.look(rig.force(), work_on(rig.tissue(), 0), rig.organ().model().energy(), reach_of(rig.organ()));
  }
  return judge.result(static_force(scene, mesh, archive, stroke), -Vector3d::UnitZ(),
                      p.cells.cast<double>().cwiseProduct(p.cell).norm());
}

}  // namespace palpate::stability
