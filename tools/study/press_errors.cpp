#include "tools/study/press_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace palpate::study {
namespace {

/// An answer that is no number would else leave an empty cell, as if it had not been asked for.
void require_number(double value, const char* what) {
  if (!std::isfinite(value)) throw std::runtime_error(fmt::format("{} does not stay a number", what));
}

}  // namespace

double course_depth(double time, double ramp, double radius) {
  const double s = std::min(1.0, time / ramp);
  return (-0.05 + 0.35 * s * s * s * (10 - 15 * s + 6 * s * s)) * radius;
}

double PressErrors::of_field(const std::vector<Eigen::Vector3d>& u,
                             const std::vector<Eigen::Vector3d>& reference) const {
  double difference = 0, size = 0;
  for (std::size_t n = 0; n < area_.size(); ++n) {
    difference += area_[n] * (u[n] - reference[n]).squaredNorm();
    size += area_[n] * reference[n].squaredNorm();
  }
  return std::sqrt(difference / size);
}

void PressErrors::add(const Row& cost, const PressAnswers& ours, const PressAnswers& reference, const std::string& name,
                      Result& result) const {
  double field = 0, force = 0;
  int count = 0;
  for (std::size_t p = 0; p < ours.size(); ++p)
    for (std::size_t d = 0; d < std::min(ours[p].size(), reference[p].size()); ++d) {
      const PressAnswer &mine = ours[p][d], &theirs = reference[p][d];
      require_number(mine.force, "the force of a press");
      if (theirs.force == 0) continue;  // so shallow that the reference itself has no contact yet
      const double of_u = of_field(mine.displacement, theirs.displacement), of_f = mine.force / theirs.force - 1;
      require_number(of_u, "the displacement of a press");
      require_number(of_f, "the force of a press");
      field += of_u * of_u;
      force += of_f * of_f;
      ++count;
      const double depth = presses_.depths[d];
      const Patch& at = presses_.patches[p];
      result.depths.push_back({cost.scene,
                               cost.method,
                               cost.knob,
                               cost.value,
                               static_cast<int>(p),
                               depth,
                               depth / presses_.radius,
                               mine.force,
                               theirs.force,
                               of_u,
                               of_f,
                               name,
                               {at.point.x(), at.point.y(), at.point.z()},
                               {-at.inward.x(), -at.inward.y(), -at.inward.z()},
                               presses_.nodes[p]});
    }
  Row row = cost;
  row.reference = name;
  if (count > 0) row.err_u_rel = std::sqrt(field / count), row.err_f_rel = std::sqrt(force / count);
  result.rows.push_back(row);
}

void add_course(Row row, const std::vector<std::array<double, 2>>& ours,
                const std::vector<std::array<double, 2>>& reference, double step, Result& result) {
  std::array<double, 2> difference{0, 0}, size{0, 0};
  for (std::size_t i = 0; i < ours.size(); ++i) {
    for (int k = 0; k < 2; ++k) {
      require_number(ours[i][k] - reference[i][k], "the course over time");
      difference[k] += std::pow(ours[i][k] - reference[i][k], 2);
      size[k] += std::pow(reference[i][k], 2);
    }
    result.courses.push_back({row.scene, row.method, row.knob, row.value, (static_cast<double>(i) + 1) * step,
                              ours[i][0], reference[i][0], ours[i][1], reference[i][1]});
  }
  row.err_f_rel = std::sqrt(difference[0] / size[0]);
  row.err_u_rel = std::sqrt(difference[1] / size[1]);
  result.rows.push_back(row);
}

}  // namespace palpate::study
