#include "tools/stability/stand_judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <span>

namespace palpate::stability {
namespace {

struct Shape {
  double mean = 0, rms = 0, alternating = 0;
};

Shape shape_of(std::span<const double> force) {
  Shape s;
  const double count = static_cast<double>(force.size());
  s.mean = std::accumulate(force.begin(), force.end(), 0.0) / count;
  double squared = 0, turning = 0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    squared += (force[i] - s.mean) * (force[i] - s.mean);
    if (i < 2) continue;
    const double turn = (force[i] - 2 * force[i - 1] + force[i - 2]) / 4;
    turning += turn * turn;
  }
  s.rms = std::sqrt(squared / count);
  s.alternating = std::sqrt(turning / count);
  return s;
}

}  // namespace

void StandJudge::look(double force, double work, double energy, double reach) {
  force_.push_back(force);
  work_ += work;
  max_work_ = larger(max_work_, work_);
  gained_ = larger(gained_, energy - work_);
  reach_ = larger(reach_, reach);
}

Result StandJudge::result(double static_force, double diagonal) const {
  const std::span<const double> window = std::span(force_).last(std::min<std::size_t>(force_.size(), kWindow));
  const Shape s = shape_of(window);
  const double scale = std::abs(static_force);
  Result r{.max_force = std::abs(*std::ranges::max_element(window, {}, [](double f) { return std::abs(f); })),
           .energy_growth = gained_,
           .note = fmt::format("{:.4g} N, static {:.4g} N", s.mean, static_force)};
  // What is not a number keeps within no bound.
  const auto hold = [&](const char* what, double value, double bound) {
    if (value <= bound) return;
    r.outcome = Outcome::failed;
    r.note += fmt::format(", {} {:.2g} (at most {:g})", what, value, bound);
  };
  hold("off the static answer by", std::abs(s.mean - static_force) / scale, kDeviation);
  hold("chatter", s.rms / scale, kChatter);
  hold("alternation", s.alternating / scale, kAlternation);
  hold("energy beyond the work", gained_ / max_work_, kEnergy);
  hold("reach over the diagonal", reach_ / diagonal, kReach);
  return r;
}

}  // namespace palpate::stability
