#pragma once
#include <filesystem>
#include <optional>

#include "tools/study/study.hpp"

namespace palpate::study {

/// What a budget buys: a setting per body.
struct Choice {
  std::vector<Point> points;  ///< one a body
  double median = 0;          ///< [s] of a step, summed over the bodies
  double p99 = 0;             ///< [s] likewise
  double error = 0;           ///< [1] the worst of all errors of displacement and force, at rest and in time
};

/// Whether the machine left a study alone: half of its steps or more have a 99th percentile of 1.5 medians at most.
bool is_quiet(const Result& result);

/// The most accurate of all combinations that a scene file can say, that can do what the scene asks and that keep what
/// it prescribes (every table that the scene has); of equal ones the fastest. The medians must fit the budget [s], on
/// a quiet run the 99th percentiles too. Errors count against fine linear elasticity for solid bodies, all modes for
/// shells, the finest chain for catheters, at rest and, of the latter two, in time. None if nothing fits.
std::optional<Choice> choose(const Methods& methods, const Scene& scene, const Result& result, double budget);

/// Writes the scene so chosen as `file`, with absolute paths. Throws std::runtime_error if it cannot be
/// written, or would not be read back as it was.
void write_choice(const Scene& scene, const Choice& choice, const std::filesystem::path& file);

}  // namespace palpate::study
