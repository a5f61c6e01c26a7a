#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/drive/expectation.hpp"
#include "tools/drive/results.hpp"

namespace palpate::drive {

/// What is asked of one run.
struct RunSettings {
  std::filesystem::path log, course;  ///< files that are written; empty: none
  std::vector<Expectation> expected;
  double seconds = 0;                                      ///< [s] of the scene; 0: until every motion is over
  std::function<void(double, double)> progress = nullptr;  ///< hears the time [s] in the scene and that since the start
};

/// Runs a scene in lock step on this thread; a result that is good or unexpected. Throws std::runtime_error if it
/// cannot be run, does not end by itself and `seconds` is 0, or Ctrl-C ends it.
PointResult run_scene(const Scene& scene, const RunSettings& settings);

}  // namespace palpate::drive
