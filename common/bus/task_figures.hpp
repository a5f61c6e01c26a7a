#pragma once
#include <array>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "idl/messages.hpp"

namespace palpate {

/// One figure of how a task goes: described once, for summaries, a drive's figures and people.
struct TaskFigure {
  std::string_view name;   ///< among a drive's figures
  std::string_view unit;   ///< SI; "1" of what is counted
  std::string_view words;  ///< before its value
  std::variant<double TaskRecord::*, std::uint64_t TaskRecord::*> field;

  double of(const TaskRecord& task) const;
  std::string key() const;              ///< in summaries: name and unit
  std::string say(double value) const;  ///< "inserted 22.1 mm"
};

/// In the order in which they are told.
std::span<const TaskFigure> task_figures();

/// For the trainee: a line of what was reached, one of how.
std::array<std::string, 2> task_lines(const std::function<double(const TaskFigure&)>& value);
std::array<std::string, 2> task_lines(const TaskRecord& task);

}  // namespace palpate
