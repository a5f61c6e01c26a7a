#include "common/describe/csv.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "common/describe/byte_order_mark.hpp"

namespace palpate {

namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const auto comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == line.npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

std::string joined(const std::vector<std::string_view>& names) {
  std::string text;
  for (std::string_view name : names) text.append(text.empty() ? "" : ",").append(name);
  return text;
}

double finite_number(const CsvTable& table, int line, std::string_view cell) {
  std::string_view digits = cell;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size())
    table.fail(line, fmt::format("'{}' is not a number", std::string(cell)));
  if (!std::isfinite(value)) table.fail(line, fmt::format("'{}' is not a finite number", std::string(cell)));
  return value;
}

}  // namespace

void CsvTable::fail(int line, std::string_view sentence) const {
  throw std::runtime_error(fmt::format("{}:{}: {}", file.string(), line, std::string(sentence)));
}

CsvTable read_csv(const std::filesystem::path& file, const std::vector<std::string_view>& columns,
                  std::string_view optional) {
  CsvTable table{file, {}};
  std::error_code error;
  std::ifstream stream(file, std::ios::binary);
  if (!std::filesystem::is_regular_file(file, error) || !stream) table.fail(1, "the file cannot be read");

  std::vector<std::string_view> longer = columns;
  std::string header = fmt::format("'{}'", joined(columns));
  if (!optional.empty()) {
    longer.push_back(optional);
    header += fmt::format(" or '{}'", joined(longer));
  }
  std::size_t wanted = 0;  // columns, once the header has been read
  int number = 0;
  for (std::string text; std::getline(stream, text);) {
    ++number;
    const std::string_view line = trimmed(number == 1 ? without_byte_order_mark(text) : text);
    if (line.empty() || line.starts_with('#')) continue;
    const std::vector<std::string_view> cells = split(line);
    if (wanted == 0) {
      if (cells != columns && cells != longer) table.fail(number, fmt::format("the header must be {}", header));
      wanted = cells.size();
      continue;
    }
    if (cells.size() != wanted)
      table.fail(number, fmt::format("{} columns are needed, and there are {}", wanted, cells.size()));
    CsvRow& row = table.rows.emplace_back(CsvRow{number, {}});
    for (std::string_view cell : cells) row.values.push_back(finite_number(table, number, cell));
  }
  if (wanted == 0) table.fail(std::max(1, number), fmt::format("the header {} is missing", header));
  if (table.rows.empty()) table.fail(number, "there is no row of numbers");
  return table;
}

}  // namespace palpate
