#include "tools/drive/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
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

}  // namespace

std::string json_line(const PointResult& result) {
  Json set = Json::object(), figures = Json::object();
  for (const SceneChange& change : result.changes) set[change.key] = change.value;
  for (const Figure& figure : result.figures)
    figures[figure.name] = std::isfinite(figure.value) ? Json(figure.value) : Json(nullptr);
  return Json{{"point", result.point},
              {"set", set},
              {"outcome", result.outcome},
              {"reason", result.reason},
              {"figures", figures}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

PointResult parse_result(const std::string& line) {
  PointResult result;
  try {
    const Json json = Json::parse(line);
    result.point = json.at("point").get<int>();
    result.outcome = json.at("outcome").get<std::string>();
    result.reason = json.at("reason").get<std::string>();
    for (const auto& [key, value] : json.at("set").items()) result.changes.push_back({key, value.get<std::string>()});
    for (const auto& [name, value] : json.at("figures").items())
      result.figures.push_back(
          {name, value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>(), ""});
  } catch (const Json::exception&) {
    throw std::runtime_error("no result of a run");
  }
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
  const auto bad = std::ranges::count_if(results, [](const PointResult& r) { return !r.good(); });
  if (results.size() < points)
    throw std::runtime_error(fmt::format("{} of {} points are missing", points - results.size(), points));
  if (bad == 0) return;
  const auto first = std::ranges::find_if(results, [](const PointResult& r) { return !r.good(); });
  throw std::runtime_error(results.size() == 1
                               ? first->reason
                               : fmt::format("{} of {} points are not as expected, such as point {}: {}", bad,
                                             results.size(), first->point, first->reason));
}

}  // namespace palpate::drive
