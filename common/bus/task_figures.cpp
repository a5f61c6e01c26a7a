#include "common/bus/task_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace palpate {
namespace {

constexpr std::array<TaskFigure, 8> kFigures{{{"inserted", "m", "inserted", &TaskRecord::inserted},
                                              {"deepest", "m", "deepest", &TaskRecord::deepest},
                                              {"inserting", "s", "reached in", &TaskRecord::inserting_s},
                                              {"held", "s", "held for", &TaskRecord::held_s},
                                              {"force.max", "N", "largest force", &TaskRecord::max_force},
                                              {"wall_contacts", "1", "wall contacts", &TaskRecord::wall_contacts},
                                              {"grasps", "1", "grasps", &TaskRecord::grasps},
                                              {"drops", "1", "drops", &TaskRecord::drops}}};
constexpr std::size_t kReached = 4;  // the first of them

}  // namespace

std::span<const TaskFigure> task_figures() {
  return kFigures;
}

double TaskFigure::of(const TaskRecord& task) const {
  return std::visit([&](const auto member) { return static_cast<double>(task.*member); }, field);
}

std::string TaskFigure::key() const {
  std::string key = unit == "1" ? std::string(name) : fmt::format("{}_{}", name, unit);
  std::ranges::transform(key, key.begin(), [](char c) { return c == '.' ? '_' : static_cast<char>(std::tolower(c)); });
  return key;
}

std::string TaskFigure::say(double value) const {
  if (unit == "m") return fmt::format("{} {:.1f} mm", words, 1e3 * value);
  if (unit == "1") return fmt::format("{} {:.0f}", words, value);
  return fmt::format("{} {:.{}f} {}", words, value, unit == "N" ? 2 : 1, unit);
}

std::array<std::string, 2> task_lines(const std::function<double(const TaskFigure&)>& value) {
  std::array<std::string, 2> lines;
  for (std::size_t i = 0; i < kFigures.size(); ++i) {
    std::string& line = lines[i < kReached ? 0 : 1];
    line += (line.empty() ? "" : ", ") + kFigures[i].say(value(kFigures[i]));
  }
  return lines;
}

std::array<std::string, 2> task_lines(const TaskRecord& task) {
  return task_lines([&](const TaskFigure& figure) { return figure.of(task); });
}

}  // namespace palpate
