#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/scene/scene_changes.hpp"
#include "tools/drive/results.hpp"

namespace palpate::drive {

/// A key and the values it takes one after the other.
struct Axis {
  std::string key;
  std::vector<std::string> values;
};

/// Reads "body.young=4000,8000"; commas within brackets or quotes part nothing. Throws std::runtime_error.
Axis parse_axis(const std::string& text);

/// Every combination of the axes' values, the last axis turning fastest, each behind `always`. Throws
/// std::runtime_error for more than kMaxPoints.
std::vector<std::vector<SceneChange>> grid(const std::vector<SceneChange>& always, const std::vector<Axis>& axes);

/// Runs each command in a process of its own, `jobs` at a time, and takes up the result that each prints; a process
/// that prints none has failed. `said` hears of each as it ends. Ctrl-C ends them all, and what has come is returned.
std::vector<PointResult> run_points(const std::vector<std::vector<std::string>>& commands, int jobs,
                                    const std::function<void(const PointResult&)>& said);

}  // namespace palpate::drive
