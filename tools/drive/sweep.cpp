#include "tools/drive/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "tools/shared/run_children.hpp"

namespace palpate::drive {

Axis parse_axis(const std::string& text) {
  const SceneChange all = parse_change(text);
  Axis axis{all.key, {""}};
  int depth = 0;
  char quote = 0;
  for (const char c : all.value) {
    if (quote != 0)
      quote = c == quote ? char{0} : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    depth += quote == 0 ? (c == '[' || c == '{') - (c == ']' || c == '}') : 0;
    if (c == ',' && depth == 0 && quote == 0)
      axis.values.emplace_back();
    else
      axis.values.back() += c;
  }
  if (std::ranges::find(axis.values, "") != axis.values.end())
    throw std::runtime_error(fmt::format("--sweep {}: give values with commas between them", text));
  return axis;
}

std::vector<std::vector<SceneChange>> grid(const std::vector<SceneChange>& always, const std::vector<Axis>& axes) {
  std::vector<std::vector<SceneChange>> points{always};
  for (const Axis& axis : axes) {
    if (std::ranges::count(axes, axis.key, &Axis::key) > 1)
      throw std::runtime_error(
          fmt::format("--sweep {}: the key is swept twice: give all its values at once", axis.key));
    if (points.size() * axis.values.size() > kMaxPoints)
      throw std::runtime_error(fmt::format("a sweep of more than {} points", kMaxPoints));
    std::vector<std::vector<SceneChange>> more;
    for (const auto& point : points)
      for (const std::string& value : axis.values) {
        more.push_back(point);
        more.back().push_back({axis.key, value});
      }
    points = std::move(more);
  }
  return points;
}

std::vector<PointResult> run_points(const std::vector<std::vector<std::string>>& commands, int jobs,
                                    const std::function<void(const PointResult&)>& said) {
  std::vector<PointResult> results;
  std::vector<std::optional<PointResult>> printed(commands.size());
  run_children("drive", commands, jobs,
               {.printed = [&](std::size_t point, const std::string& line) { printed[point] = parse_result(line); },
                .ended =
                    [&](std::size_t point, int status) {
                      results.push_back(printed[point].value_or(PointResult{
                          .outcome = PointResult::kFailed,
                          .reason = fmt::format("its process ended with status {} and no result", status)}));
                      results.back().point = static_cast<int>(point);
                      said(results.back());
                    }});
  std::ranges::sort(results, {}, &PointResult::point);
  return results;
}

}  // namespace palpate::drive
