#pragma once
#include <filesystem>
#include <optional>

#include "tools/study/study.hpp"

namespace palpate::study {

/// What a budget buys: a setting per body, the sum of whose 99th percentiles fits.
struct Choice {
  std::vector<Point> points;  ///< one a body
  double p99 = 0;             ///< [s] sum
  double error = 0;           ///< [1] the worst of all errors of displacement and force, at rest and in time
};

/// The most accurate of all combinations that a scene file can say and that can do what the scene asks; of
/// equal ones the fastest. Errors count against fine linear elasticity for solid bodies, all modes for
/// shells, the finest chain for catheters, at rest and, of the latter two, in time. None if nothing fits.
std::optional<Choice> choose(const Methods& methods, int bodies, const Result& result, double budget);

/// Writes the scene so chosen as `file`, with absolute paths. Throws std::runtime_error if it cannot be
/// written, or would not be read back as it was.
void write_choice(const Scene& scene, const Choice& choice, const std::filesystem::path& file);

}  // namespace palpate::study
