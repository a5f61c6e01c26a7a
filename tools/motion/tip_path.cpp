#include "tools/motion/tip_path.hpp"

#include "common/tool/instrument.hpp"

namespace palpate {
namespace {

constexpr double kStep = 1e-3, kStands = 1e-3;  // [s], [m/s]
constexpr double kApart = 5e-4;                 // [m]

void add_if_apart(std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& point) {
  if (points.empty() || (point - points.back()).norm() >= kApart) points.push_back(point);
}

}  // namespace

double reach_of(const Tool& tool) {
  const auto shape = forceps_shape(tool);
  return shape ? shape->jaw_length : 0;
}

TipPath tip_path(const Trocar& trocar, double reach, const Trajectory& motion) {
  const auto tip = [&](double time) {
    return Eigen::Vector3d(tip_pose(trocar, motion.at(time)) * (reach * Eigen::Vector3d::UnitZ()));
  };
  TipPath path;
  Eigen::Vector3d before = tip(0);
  bool stood = false;
  for (double time = 0; time < motion.duration(); time += kStep) {
    const Eigen::Vector3d now = tip(time);
    const bool stands = (now - before).norm() < kStands * kStep;
    if (stands && !stood) add_if_apart(path.stands, now);
    add_if_apart(path.points, now);
    stood = stands;
    before = now;
  }
  path.points.push_back(tip(motion.duration()));
  add_if_apart(path.stands, path.points.back());
  return path;
}

}  // namespace palpate
