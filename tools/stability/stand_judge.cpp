#include "tools/stability/stand_judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace palpate::stability {
namespace {

struct Shape {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double rms = 0, alternating = 0;
};

Shape shape_of(std::span<const Eigen::Vector3d> force) {
  Shape s;
  const double count = static_cast<double>(force.size());
  for (const Eigen::Vector3d& f : force) s.mean += f / count;
  double squared = 0, turning = 0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    squared += (force[i] - s.mean).squaredNorm();
    if (i >= 2) turning += ((force[i] - 2 * force[i - 1] + force[i - 2]) / 4).squaredNorm();
  }
  s.rms = std::sqrt(squared / count);
  s.alternating = std::sqrt(turning / count);
  return s;
}

}  // namespace

void StandJudge::look(const Eigen::Vector3d& force, double work, double energy, double reach) {
  force_.push_back(force);
  work_ += work;
  max_work_ = larger(max_work_, work_);
  gained_ = larger(gained_, energy - work_);
  reach_ = larger(reach_, reach);
}

Result StandJudge::result(double static_force, const Eigen::Vector3d& press, double diagonal) const {
  const std::span<const Eigen::Vector3d> window = std::span(force_).last(std::min<std::size_t>(force_.size(), kWindow));
  const Shape s = shape_of(window);
  const double scale = std::abs(static_force), mean = s.mean.dot(press);
  Result r{.energy_growth = gained_, .note = fmt::format("{:.4g} N, static {:.4g} N", mean, static_force)};
  for (const Eigen::Vector3d& f : window) r.max_force = larger(r.max_force, f.norm());
  hold(r, "off the static answer by", std::abs(mean - static_force) / scale, kDeviation);
  hold(r, "chatter", s.rms / scale, kChatter);
  hold(r, "alternation", s.alternating / scale, kAlternation);
  hold(r, "energy beyond the work", gained_ / max_work_, kEnergy);
  hold(r, "reach over the diagonal", reach_ / diagonal, kReach);
  return r;
}

}  // namespace palpate::stability
