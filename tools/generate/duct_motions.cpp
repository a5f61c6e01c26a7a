#include "tools/generate/duct_motions.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/generate/scripted_motion.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

const TurningJaws& jaws_of(const Tool& tool) {
  return std::get<ForcepsSpec>(tool.end).jaws;
}

Vector3d along_duct(const DuctShape& duct, double s) {
  return (duct.centre(s + 1e-4) - duct.centre(s - 1e-4)).normalized();
}

/// The same work place, with the tool drawn back along its shaft.
JawTarget back(JawTarget target, double distance) {
  target.ahead += distance;
  return target;
}

/// How far before the duct's centre line the joint lies when both jaws, so far open, touch the wall.
double ahead_at_touch(const Tool& tool, const Trocar& trocar, const DuctShape& duct, double thickness, double s,
                      double opening) {
  const double wanted = duct.radius_at(s) + 0.5 * thickness + jaws_of(tool).radius;
  return wanted / jaw_distance(trocar, {duct.centre(s), along_duct(duct, s), 1}, opening);
}

/// How far before the duct's centre line the joint lies when the closed jaws' tips touch the wall.
double ahead_at_poke(const Tool& tool, const Trocar& trocar, const DuctShape& duct, double thickness, double s) {
  const Vector3d axis = along_duct(duct, s), shaft = (duct.centre(s) - trocar.pivot).normalized();
  const double steep = shaft.cross(axis).norm();  // 1 where the tool comes straight at the wall
  return jaws_of(tool).length + (duct.radius_at(s) + 0.5 * thickness + jaws_of(tool).radius) / steep;
}

/// The first body of this kind; null if the scene has none.
template <class Spec>
const Spec* first(const Scene& scene) {
  for (const Body& body : scene.bodies)
    if (const auto* spec = as<Spec>(body)) return spec;
  return nullptr;
}

}  // namespace

std::string feeding_motion(const Tool& tool, const Catheter& catheter, const FeedPlan& plan) {
  const Vector3d inward = (catheter.tip - catheter.tail).normalized();
  const Vector3d mouth = Vector3d::Zero();
  const double ahead = plan.share * jaws_of(tool).length;
  const auto at = [&](double before) { return JawTarget{mouth - before * inward, inward, ahead}; };
  const JawTarget far = at(plan.nearest + plan.stroke), near = at(plan.nearest);

  ScriptedMotion motion(tool, back(far, plan.withdrawn), plan.open);
  motion.wait(1.5);
  motion.move(plan.approach_time, far);
  motion.grip(plan.grip_time, plan.closed);
  for (int stroke = 0; stroke < plan.strokes; ++stroke) {
    motion.move(plan.stroke_time, near);
    motion.grip(plan.grip_time, plan.open);
    if (stroke + 1 == plan.strokes) break;
    motion.move(plan.back_time, far);
    motion.grip(plan.grip_time, plan.closed);
  }
  motion.move(plan.approach_time, back(near, plan.withdrawn));
  motion.wait(1);
  return motion.csv("A forceps feeds the catheter into the duct, hand over hand.");
}

std::string steadying_motion(const Tool& tool, const DuctShape& duct, double thickness, const SteadyPlan& plan) {
  const Trocar trocar = make_trocar(tool.pivot, tool.axis, tool.up);
  const double ahead = ahead_at_touch(tool, trocar, duct, thickness, plan.place, plan.open);
  const JawTarget touch{duct.centre(plan.place), along_duct(duct, plan.place), ahead};

  ScriptedMotion motion(tool, back(touch, plan.withdrawn), plan.open);
  motion.wait(0.5);
  motion.move(plan.approach_time, back(touch, 0.0005));
  motion.move(plan.push_time, back(touch, -plan.push));
  motion.wait(std::max(0.1, plan.hold_until - motion.time()));
  motion.move(plan.approach_time, back(touch, plan.withdrawn));
  return motion.csv("A forceps steadies the duct near its mouth, between open jaws.");
}

std::string poking_motion(const Tool& tool, const DuctShape& duct, double thickness, const PokePlan& plan) {
  const Trocar trocar = make_trocar(tool.pivot, tool.axis, tool.up);
  const auto poke_at = [&](double s) {
    return JawTarget{duct.centre(s), along_duct(duct, s), ahead_at_poke(tool, trocar, duct, thickness, s)};
  };
  const JawTarget poke = poke_at(plan.poke_place);
  const auto beside =
      [&](double gap) {  // the middle of the jaws, so far from touching the duct's side with their flank
        const Vector3d centre = duct.centre(plan.push_place), axis = along_duct(duct, plan.push_place);
        const Vector3d side = (centre - trocar.pivot).cross(axis).normalized();
        const double distance = duct.radius_at(plan.push_place) + 0.5 * thickness + jaws_of(tool).radius + gap;
        return JawTarget{centre + distance * side, axis, 0.5 * jaws_of(tool).length};
      };
  const JawTarget grasp{duct.centre(plan.grasp_place), along_duct(duct, plan.grasp_place),
                        plan.share * jaws_of(tool).length};

  ScriptedMotion motion(tool, back(poke, plan.withdrawn), 0);
  motion.wait(0.5);
  motion.move(0.8, back(poke, 0.0005));
  motion.move(0.5, back(poke, -plan.poke));
  motion.move(0.6, back(poke, plan.withdrawn));
  motion.move(0.8, back(beside(0.002), plan.withdrawn));
  motion.move(0.6, beside(0.002));
  motion.move(0.8, beside(-plan.push));
  motion.wait(0.3);
  motion.move(0.4, beside(0.001));
  motion.move(0.6, back(beside(0.002), plan.withdrawn));
  motion.grip(0.4, plan.open);
  motion.move(0.6, back(grasp, plan.withdrawn));
  motion.move(0.8, grasp);
  motion.grip(0.8, plan.closed);
  motion.move(1.0, back(grasp, plan.pull));
  motion.wait(0.5);
  motion.grip(0.5, plan.open);
  motion.move(0.8, back(grasp, plan.withdrawn + 0.010));
  motion.wait(0.3);
  return motion.csv("A forceps pokes the duct, pushes it, grasps it, pulls and lets go.");
}

std::string duct_motion(const Scene& scene, const Tool& tool) {
  const auto* duct = first<ShellSpec>(scene);
  const auto* wire = first<CatheterSpec>(scene);
  if (!std::holds_alternative<ForcepsSpec>(tool.end) || !duct)
    throw std::runtime_error(
        "the motions of the duct's scenes are for a forceps and a body of the model 'modal_shell'");
  if (tool.name == "left") return steadying_motion(tool, {}, duct->shell.thickness);
  if (tool.name == "forceps") return poking_motion(tool, {}, duct->shell.thickness);
  if (tool.name == "right" && wire) return feeding_motion(tool, wire->catheter);
  throw std::runtime_error("no motion is known for a tool '" + tool.name + "' in this scene");
}

}  // namespace palpate
