#include "tools/stability/case.hpp"

#include <fmt/format.h>

namespace palpate::stability {

const char* word_of(Outcome outcome) {
  static constexpr const char* kWords[] = {"stable", "regularised", "refused", "failed"};
  return kWords[static_cast<int>(outcome)];
}

void hold(Result& row, const char* what, double value, double bound) {
  if (value <= bound) return;
  row.outcome = Outcome::failed;
  row.note += fmt::format("{}{} {:.2g} (at most {:g})", row.note.empty() ? "" : ", ", what, value, bound);
}

std::vector<Point> all_points(const Extent& extent) {
  std::vector<Point> all;
  for (const auto subject : {loop_points, material_points, geometry_points, hold_points, press_points, curve_points,
                             dynamic_points, moving_points, cut_points, hybrid_points, shell_points, catheter_points}) {
    const std::vector<Point> points = subject(extent);
    all.insert(all.end(), points.begin(), points.end());
  }
  return all;
}

}  // namespace palpate::stability
