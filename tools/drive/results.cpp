#include "tools/drive/results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace palpate::drive {
namespace {

using Json = nlohmann::ordered_json;

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == text.npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c == '\n' ? ' ' : c);
  return out + "\"";
}

std::string line_of(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) line.append(line.empty() ? "" : ",").append(quoted(field));
  return line + "\n";
}

void add_new(std::vector<std::string>& names, const std::string& name) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

std::string value_of(const PointResult& result, const std::string& key) {
  std::string value;
  for (const SceneChange& change : result.changes)
    if (change.key == key) value = change.value;  // the last one holds
  return value;
}

std::string figure_of(const PointResult& result, const std::string& name) {
  const auto found = std::ranges::find(result.figures, name, &Figure::name);
  return found == result.figures.end() ? std::string() : fmt::format("{:.9g}", found->value);
}

/// A sweep has so many points that its missing ones can be looked for.
bool numbered_well(const PointResult& result) {
  if (result.points == 0) return true;
  return result.points > 0 && static_cast<std::size_t>(result.points) <= kMaxPoints && result.point >= 0 &&
         result.point < result.points;
}

bool failed(const PointResult& result) {
  return result.outcome == PointResult::kFailed;
}

/// Of the same point, apart from what each run measures anew.
bool tell_the_same(const PointResult& a, const PointResult& b) {
  const auto lasting = [](PointResult result) {
    std::erase_if(result.figures, [](const Figure& f) { return f.name == "wall" || f.name == "realtime_factor"; });
    return json_line(result);  // what is no number is equal to itself there
  };
  return lasting(a) == lasting(b);
}

bool same_changes(const PointResult& a, const PointResult& b) {
  return std::ranges::equal(a.changes, b.changes,
                            [](const SceneChange& x, const SceneChange& y) { return x.argument() == y.argument(); });
}

/// Whether of two results of a point one has all that is known: they are equal, or a run that failed was made again.
bool one_is_enough(const PointResult& a, const PointResult& b) {
  return tell_the_same(a, b) || (same_changes(a, b) && failed(a) != failed(b));
}

std::vector<int> twice_told(const std::vector<PointResult>& results) {
  std::map<int, int> times;
  for (const PointResult& result : results)
    if (result.points > 0) ++times[result.point];
  std::vector<int> twice;
  for (const auto& [point, n] : times)
    if (n > 1) twice.push_back(point);
  return twice;
}

std::vector<int> missing_points(const std::vector<PointResult>& results, std::size_t points) {
  std::vector<bool> there(points);
  for (const PointResult& result : results)
    if (result.points > 0 && static_cast<std::size_t>(result.point) < points) there[result.point] = true;
  std::vector<int> missing;
  for (std::size_t i = 0; i < points; ++i)
    if (!there[i]) missing.push_back(static_cast<int>(i));
  return missing;
}

/// The first ones by their numbers.
std::string list_of(const std::vector<int>& points) {
  constexpr std::size_t kListed = 20;
  const std::size_t listed = std::min(points.size(), kListed);
  return fmt::format("{}{}", fmt::join(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(listed), ", "),
                     listed < points.size() ? ", ..." : "");
}

/// Throws, with the nearest there is, if no result has the figure.
void refuse_if_nobody_has(const Expectation& expected, const std::vector<PointResult>& results) {
  const auto has = [&](const PointResult& r) { return find(r.figures, expected.figure).has_value(); };
  if (std::ranges::any_of(results, has)) return;
  const auto ran = std::ranges::find_if_not(results, failed);
  if (ran != results.end()) disappointment(expected, ran->figures);
}

void hold_to(const std::vector<Expectation>& expected, PointResult& result) try {
  const std::string why = disappointments(expected, result.figures);
  if (why.empty()) return;
  result.outcome = PointResult::kUnexpected;
  result.reason += (result.reason.empty() ? "" : "; ") + why;
} catch (const std::runtime_error& error) {  // as the run itself would have said that it lacks the figure
  result.outcome = PointResult::kFailed;
  result.reason = error.what();
}

/// Why the results are not all that a sweep should come to; empty where they are.
std::string shortcomings(const std::vector<PointResult>& results, std::size_t points) {
  std::vector<std::string> all;
  if (const auto missing = missing_points(results, points); !missing.empty())
    all.push_back(fmt::format("{} of {} points are missing: {}", missing.size(), points, list_of(missing)));
  if (const auto twice = twice_told(results); !twice.empty())
    all.push_back(fmt::format("points with several results that differ, a row for each: {}", list_of(twice)));
  const auto bad = std::ranges::count_if(results, [](const PointResult& r) { return !r.good(); });
  if (bad == 0) return fmt::format("{}", fmt::join(all, "; "));
  const auto first = std::ranges::find_if(results, [](const PointResult& r) { return !r.good(); });
  all.push_back(results.size() == 1 ? first->reason
                                    : fmt::format("{} of {} points are not as expected, such as point {}: {}", bad,
                                                  results.size(), first->point, first->reason));
  return fmt::format("{}", fmt::join(all, "; "));
}

}  // namespace

std::string json_line(const PointResult& result) {
  Json set = Json::object(), figures = Json::object();
  for (const SceneChange& change : result.changes) set[change.key] = change.value;
  for (const Figure& figure : result.figures)
    figures[figure.name] = std::isfinite(figure.value) ? Json(figure.value) : Json(nullptr);
  Json line{{"point", result.point}};
  if (result.points > 0) line["points"] = result.points;
  line.update(Json{{"set", set}, {"outcome", result.outcome}, {"reason", result.reason}, {"figures", figures}});
  return line.dump(-1, ' ', false, Json::error_handler_t::replace);
}

PointResult parse_result(const std::string& line) {
  PointResult result;
  try {
    const Json json = Json::parse(line);
    result.point = json.at("point").get<int>();
    result.points = json.value("points", 0);
    result.outcome = json.at("outcome").get<std::string>();
    result.reason = json.at("reason").get<std::string>();
    for (const auto& [key, value] : json.at("set").items()) result.changes.push_back({key, value.get<std::string>()});
    for (const auto& [name, value] : json.at("figures").items())
      result.figures.push_back(
          {name, value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>(), ""});
  } catch (const Json::exception&) {
    throw std::runtime_error("no result of a run");
  }
  if (!numbered_well(result)) throw std::runtime_error("no result of a run");
  return result;
}

std::vector<PointResult> read_results(const std::vector<std::filesystem::path>& files) {
  std::vector<PointResult> results;
  for (const std::filesystem::path& file : files) {
    std::error_code error;
    std::ifstream in;
    if (std::filesystem::is_regular_file(file, error)) in.open(file);
    if (!in.is_open()) throw std::runtime_error(fmt::format("{}: no file that can be read", file.string()));
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      if (line.empty()) continue;
      try {
        results.push_back(parse_result(line));
      } catch (const std::runtime_error& why) {
        throw std::runtime_error(fmt::format("{}:{}: {}", file.string(), number, why.what()));
      }
    }
  }
  if (results.empty()) throw std::runtime_error("the files hold no result");
  return results;
}

std::vector<std::string> drop_repeated(std::vector<PointResult>& results) {
  std::vector<PointResult> kept;
  std::vector<std::string> said;
  std::map<int, std::vector<std::size_t>> of_point;  // where they are kept
  for (const PointResult& result : results) {
    std::vector<std::size_t> alone;
    std::vector<std::size_t>& others = result.points > 0 ? of_point[result.point] : alone;
    const auto same = std::ranges::find_if(others, [&](std::size_t i) { return one_is_enough(result, kept[i]); });
    if (same == others.end()) {
      others.push_back(kept.size());
      kept.push_back(result);
      continue;
    }
    const bool one_failed = failed(result) != failed(kept[*same]);
    said.push_back(fmt::format("point {} has two results, {}: one is kept", result.point,
                               one_failed ? "of which one failed" : "which are equal"));
    if (failed(kept[*same])) kept[*same] = result;
  }
  results = std::move(kept);
  return said;
}

void expect_of(std::vector<PointResult>& results, const std::vector<Expectation>& expected) {
  for (const Expectation& e : expected) refuse_if_nobody_has(e, results);
  for (PointResult& result : results)
    if (!failed(result)) hold_to(expected, result);
}

std::size_t points_of(const std::vector<PointResult>& results) {
  int points = 0;
  for (const PointResult& result : results) {
    if (result.points > 0 && points > 0 && result.points != points)
      throw std::runtime_error(
          fmt::format("the results are of a sweep of {} points and of one of {}: merge those of one sweep at a time",
                      points, result.points));
    points = std::max(points, result.points);
  }
  return static_cast<std::size_t>(points);
}

std::string csv_table(std::vector<PointResult> results) {
  std::ranges::stable_sort(results, {}, &PointResult::point);
  std::vector<std::string> keys, figures;
  for (const PointResult& result : results) {
    for (const SceneChange& change : result.changes) add_new(keys, change.key);
    for (const Figure& figure : result.figures) add_new(figures, figure.name);
  }
  std::vector<std::string> heading{"point"};
  heading.insert(heading.end(), keys.begin(), keys.end());
  heading.push_back("outcome");
  heading.insert(heading.end(), figures.begin(), figures.end());
  heading.push_back("reason");
  std::string table = line_of(heading);
  for (const PointResult& result : results) {
    std::vector<std::string> row{std::to_string(result.point)};
    for (const std::string& key : keys) row.push_back(value_of(result, key));
    row.push_back(result.outcome);
    for (const std::string& name : figures) row.push_back(figure_of(result, name));
    row.push_back(result.reason);
    table += line_of(row);
  }
  return table;
}

std::string text_of(const PointResult& result) {
  std::size_t width = 0;
  for (const Figure& figure : result.figures) width = std::max(width, figure.name.size());
  std::string text;
  for (const Figure& figure : result.figures)
    text += fmt::format("{:<{}}  {:<12.6g} {}\n", figure.name, width, figure.value, figure.unit);
  return text;
}

void require_good(const std::vector<PointResult>& results, std::size_t points) {
  if (const std::string why = shortcomings(results, points); !why.empty()) throw std::runtime_error(why);
}

}  // namespace palpate::drive
