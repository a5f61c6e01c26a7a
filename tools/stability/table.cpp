#include "tools/stability/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>

namespace palpate::stability {
namespace {

constexpr const char* heading = "case,parameter,value,outcome,max_force,energy_growth,note";

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? '\'' : c;
  return out + "\"";
}

std::string line_of(const Row& r) {
  return fmt::format("{},{},{},{},{:.6g},{:.6g},{}\n", quoted(r.name), quoted(r.parameter), quoted(r.value), r.outcome, r.max_force, r.energy_growth, quoted(r.note));
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool inside = false;
  for (const char c : line) {
    if (c == '"')
      inside = !inside;
    else if (c == ',' && !inside)
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

}  // namespace

std::vector<Row> read_rows(const std::filesystem::path& file) {
  std::vector<Row> rows;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    const auto f = fields_of(line);
    if (f.size() != 7) continue;  // a line that was cut off by an interruption
    try {
      rows.push_back({f[0], f[1], f[2], f[3], std::stod(f[4]), std::stod(f[5]), f[6]});
    } catch (const std::exception&) {
      throw std::runtime_error(fmt::format("{}: a line is no row of this table: {}", file.string(), line));
    }
  }
  return rows;
}

int run_table(const std::vector<Point>& points, const std::filesystem::path& folder, const std::string& subject) {
  std::filesystem::create_directories(folder);
  const auto csv = folder / "stability.csv", mark = folder / "subject.txt";
  std::vector<Row> before;
  if (text_of(mark) == subject) before = read_rows(csv);
  std::ofstream(mark) << subject << "\n";
  std::ofstream out(csv);
  if (!out) throw std::runtime_error(fmt::format("{} cannot be written", csv.string()));
  out << heading << "\n";
  int failed = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& p = points[i];
    const auto same = [&](const Row& r) { return r.name == p.name && r.parameter == p.parameter && r.value == p.value && r.outcome != "failed"; };
    const auto kept = std::ranges::find_if(before, same);
    const auto begin = std::chrono::steady_clock::now();
    const Row row = kept != before.end() ? *kept : run_guarded(p);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    failed += row.outcome == "failed";
    out << line_of(row) << std::flush;
    fmt::print(stderr, "[{}/{}] {}, {} {}: {} ({:.1f} s) {}\n", i + 1, points.size(), row.name, row.parameter, row.value, row.outcome, seconds, row.note);
  }
  return failed;
}

}  // namespace palpate::stability
