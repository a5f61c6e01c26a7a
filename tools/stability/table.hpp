#pragma once
#include <filesystem>

#include "tools/stability/case.hpp"

namespace palpate::stability {

/// Runs the points one by one and writes `folder`/stability.csv after each; rows that are there from an interrupted run of the
/// same `subject` (scene and version) are kept. Progress on stderr. Returns how many points failed.
int run_table(const std::vector<Point>& points, const std::filesystem::path& folder, const std::string& subject);

/// Rows of a stability.csv; empty if there is none. Throws std::runtime_error if it cannot be read.
std::vector<Row> read_rows(const std::filesystem::path& file);

}  // namespace palpate::stability
