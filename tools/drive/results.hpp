#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "common/scene/scene_changes.hpp"
#include "tools/drive/expectation.hpp"
#include "tools/drive/figures.hpp"

namespace palpate::drive {

inline constexpr std::size_t kMaxPoints = 100'000;  ///< of a sweep

/// What became of one point of a sweep, or of a run alone.
struct PointResult {
  static constexpr const char* kGood = "ok";
  static constexpr const char* kUnexpected = "unexpected";  ///< it ran, and an expectation does not hold
  static constexpr const char* kFailed = "failed";          ///< it did not run to its end

  int point = 0;   ///< its number in the sweep, from 0
  int points = 0;  ///< of the whole sweep; 0 for a run alone
  std::vector<SceneChange> changes;
  std::string outcome = kGood;
  std::string reason;  ///< empty where it is good
  Figures figures;

  bool good() const { return outcome == kGood; }
};

/// One line of JSON, without its end; parse_result() reads it back but for the units. What is no number is null.
std::string json_line(const PointResult& result);
/// Throws std::runtime_error in one sentence if the line is no such result.
PointResult parse_result(const std::string& line);

/// Results in the lines of files; other lines are refused with their place. Throws std::runtime_error.
std::vector<PointResult> read_results(const std::vector<std::filesystem::path>& files);

/// Takes out results that tell again of a point of a sweep what another one tells, whatever time each took, and those
/// of a run that failed where another run of the point did not. What it did, a sentence a point.
std::vector<std::string> drop_repeated(std::vector<PointResult>& results);

/// Holds each result to what is expected, beside what it was held to already. Throws std::runtime_error if no result
/// has such a figure.
void expect_of(std::vector<PointResult>& results, const std::vector<Expectation>& expected);

/// How many points the sweep has that the results are of; 0 for runs alone. Throws std::runtime_error if they are of
/// several sweeps.
std::size_t points_of(const std::vector<PointResult>& results);

/// One row a point, in their order, with a column for each changed key and each figure that one of them has.
std::string csv_table(std::vector<PointResult> results);
/// One figure a line, with its unit.
std::string text_of(const PointResult& result);

/// Throws std::runtime_error if a point is not good, is missing or is told of twice; `points`: how many there should
/// be, 0 for runs alone.
void require_good(const std::vector<PointResult>& results, std::size_t points);

}  // namespace palpate::drive
