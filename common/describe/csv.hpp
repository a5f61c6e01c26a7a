#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// One line of numbers.
struct CsvRow {
  int line;  ///< in the file, from 1
  std::vector<double> values;
};

/// A file of numbers in named columns.
struct CsvTable {
  std::filesystem::path file;
  std::vector<CsvRow> rows;

  /// Throws std::runtime_error("FILE:LINE: sentence").
  [[noreturn]] void fail(int line, std::string_view sentence) const;
};

/// Reads comma-separated finite numbers below a header that names exactly `columns`, or those and then
/// `optional`, where it is not empty. Lines that begin with '#', empty lines and a byte-order mark are skipped. Throws
/// std::runtime_error("FILE:LINE: sentence"), also when there is no row.
CsvTable read_csv(const std::filesystem::path& file, const std::vector<std::string_view>& columns,
                  std::string_view optional = {});

}  // namespace palpate
