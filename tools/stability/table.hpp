#pragma once
#include <filesystem>
#include <optional>

#include "tools/stability/case.hpp"

namespace palpate::stability {

struct TableRun {
  std::string only;                  ///< the points whose name contains this
  std::optional<std::size_t> point;  ///< this one of the points alone
  int jobs = 1;                      ///< at the same time
  /// A list of points that are known to fail, as `case | parameter | value | why` a line; # begins a comment. Empty:
  /// none is.
  std::filesystem::path known;
};

/// Where one point that is run alone leaves its row, for a table of all of them in `folder`.
std::filesystem::path folder_of_point(const std::filesystem::path& folder, std::size_t point);

/// Runs these points and writes `folder`/stability.csv after each, in the order of `points`; rows that are there from
/// an earlier run for the same `subject` stay, failed ones until they have been run again; those of points that were
/// run alone are taken out of their folders. Progress on stderr. Returns how many of those points failed that are not
/// known to; of a known one that did not fail it tells on stderr. Throws std::runtime_error if the folder cannot be
/// written or holds another table of that name, or the list cannot be read.
int run_table(const std::vector<Point>& points, const std::filesystem::path& folder, const std::string& subject,
              const TableRun& how = {});

/// Rows of a stability.csv; empty if there is none. Throws std::runtime_error if it cannot be read.
std::vector<Row> read_rows(const std::filesystem::path& file);

}  // namespace palpate::stability
