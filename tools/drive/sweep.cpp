#include "tools/drive/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <list>
#include <optional>
#include <stdexcept>
#include <thread>

#include "common/realtime/shutdown.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate::drive {
namespace {

using namespace std::chrono_literals;

/// A point that is being computed.
struct Running {
  int point;
  ChildProcess process;
  std::optional<PointResult> result;

  void read() {
    for (const std::string& line : process.take_lines()) {
      result = parse_result(line);
      result->point = point;
    }
  }
  PointResult take_result() {
    read();
    if (result) return *result;
    return {.point = point,
            .outcome = PointResult::kFailed,
            .reason = fmt::format("its process ended with status {} and no result", process.status())};
  }
};

}  // namespace

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

std::string shell_line(const std::vector<std::string>& arguments) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+%@";
  std::string line;
  for (const std::string& argument : arguments) {
    if (!line.empty()) line += ' ';
    if (!argument.empty() && argument.find_first_not_of(kPlain) == argument.npos) {
      line += argument;
      continue;
    }
    line += '\'';
    for (const char c : argument) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

std::vector<PointResult> run_points(const std::vector<std::vector<std::string>>& commands, int jobs,
                                    const std::function<void(const PointResult&)>& said) {
  std::vector<PointResult> results;
  std::list<Running> running;
  std::size_t next = 0;
  while ((next < commands.size() || !running.empty()) && !shutdown_requested()) {
    while (next < commands.size() && static_cast<int>(running.size()) < jobs) {
      running.push_back({static_cast<int>(next), ChildProcess("drive", commands[next]), {}});
      ++next;
    }
    for (auto child = running.begin(); child != running.end();) {
      child->read();
      if (child->process.running()) {
        ++child;
        continue;
      }
      results.push_back(child->take_result());
      said(results.back());
      child = running.erase(child);
    }
    std::this_thread::sleep_for(2ms);
  }
  std::ranges::sort(results, {}, &PointResult::point);
  return results;
}

}  // namespace palpate::drive
