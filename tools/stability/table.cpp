#include "tools/stability/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <optional>
#include <set>
#include <stdexcept>

#include "common/cli/progress.hpp"
#include "common/files/atomic_file.hpp"
#include "tools/stability/guarded_run.hpp"
#include "tools/study/output_folder.hpp"

namespace palpate::stability {
namespace {

constexpr const char *kTable = "stability.csv", *kSubject = "subject.txt";
constexpr const char* kHeading = "case,parameter,value,outcome,max_force,energy_growth,note";

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? '\'' : c;
  return out + "\"";
}

std::string line_of(const Row& r) {
  return fmt::format("{},{},{},{},{:.6g},{:.6g},{}\n", quoted(r.name), quoted(r.parameter), quoted(r.value), r.outcome,
                     r.max_force, r.energy_growth, quoted(r.note));
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

/// Whole or as it was.
void write_rows(const std::vector<std::optional<Row>>& rows, const std::filesystem::path& file) {
  AtomicFile whole(file);
  std::ofstream out(whole.handle());
  out << kHeading << "\n";
  for (const auto& row : rows)
    if (row) out << line_of(*row);
  if (!out.flush()) throw std::runtime_error(fmt::format("{}: cannot be written", file.string()));
  whole.commit();
}

std::string id_of(const std::string& name, const std::string& parameter, const std::string& value) {
  return fmt::format("{} | {} | {}", name, parameter, value);
}

/// The ids of a list of points that are known to fail.
std::set<std::string> read_known(const std::filesystem::path& file) {
  std::set<std::string> known;
  if (file.empty()) return known;
  std::ifstream in(file);
  if (!in) throw std::runtime_error(fmt::format("{}: cannot be read", file.string()));
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (std::ranges::count(line, '|') != 3)
      throw std::runtime_error(
          fmt::format("{}: a line is no `case | parameter | value | why`: {}", file.string(), line));
    known.insert(line.substr(0, line.rfind(" | ")));
  }
  return known;
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
    try {
      if (f.size() != 7) throw std::invalid_argument("columns");
      rows.push_back({f[0], f[1], f[2], f[3], std::stod(f[4]), std::stod(f[5]), f[6]});
    } catch (const std::exception&) {
      throw std::runtime_error(fmt::format("{}: a line is no row of this table: {}", file.string(), line));
    }
  }
  return rows;
}

namespace {

/// Of a folder's table; none where it is of another subject.
std::vector<Row> rows_for(const std::filesystem::path& folder, const std::string& subject) {
  return text_of(folder / kSubject) == subject ? read_rows(folder / kTable) : std::vector<Row>();
}

std::optional<Row> row_of(const Point& p, const std::vector<Row>& rows) {
  const auto kept = std::ranges::find_if(
      rows, [&](const Row& r) { return r.name == p.name && r.parameter == p.parameter && r.value == p.value; });
  return kept == rows.end() ? std::nullopt : std::optional(*kept);
}

}  // namespace

std::filesystem::path folder_of_point(const std::filesystem::path& folder, std::size_t point) {
  return folder / "points" / std::to_string(point);
}

int run_table(const std::vector<Point>& points, const std::filesystem::path& folder, const std::string& subject,
              const TableRun& how) {
  const std::set<std::string> known = read_known(how.known);
  if (how.point && *how.point >= points.size())
    throw std::runtime_error(fmt::format("stability: there are {} points, from 0 on", points.size()));
  const auto asked = [&](const Point& p) {
    return how.point ? &p == &points[*how.point] : p.name.find(how.only) != std::string::npos;
  };
  if (std::ranges::none_of(points, asked))
    throw std::runtime_error(fmt::format("stability: no case's name contains '{}'", how.only));
  const auto csv = folder / kTable, mark = folder / kSubject;
  prepare_folder(folder, {csv.filename(), fmt::format("{}\n", kHeading)}, {"index.html"});
  const std::vector<Row> before = rows_for(folder, subject);
  std::ofstream(mark) << subject << "\n";
  std::vector<std::optional<Row>> rows;
  std::vector<Point> to_run;
  std::vector<std::size_t> places;
  std::vector<std::filesystem::path> taken;
  for (const Point& p : points) {
    const std::filesystem::path alone = folder_of_point(folder, rows.size());
    rows.push_back(row_of(p, rows_for(alone, subject)));
    if (rows.back()) {
      taken.push_back(alone);
      continue;
    }
    rows.back() = row_of(p, before);
    if (!asked(p) || (rows.back() && rows.back()->outcome != "failed")) continue;
    places.push_back(rows.size() - 1);
    to_run.push_back(p);
  }
  write_rows(rows, csv);
  for (const std::filesystem::path& alone : taken) std::filesystem::remove_all(alone);
  std::size_t done = 0;
  run_guarded(to_run, how.jobs, [&](const GuardedRow& ended) {
    const Row& row = ended.row;
    rows[places[ended.point]] = row;
    write_rows(rows, csv);
    cli::say(fmt::format("[{}/{}] {}, {} {}: {} ({:.1f} s) {}", ++done, to_run.size(), row.name, row.parameter,
                         row.value, row.outcome, ended.seconds, row.note));
  });
  write_rows(rows, csv);
  int failed = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!asked(points[i])) continue;
    const std::string id = id_of(points[i].name, points[i].parameter, points[i].value);
    const bool fails = rows[i]->outcome == "failed";
    failed += fails && !known.contains(id);
    if (!fails && known.contains(id)) cli::say(fmt::format("known to fail, and does not: {}", id));
  }
  return failed;
}

}  // namespace palpate::stability
