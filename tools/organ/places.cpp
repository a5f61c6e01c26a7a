#include "tools/organ/places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <stdexcept>

#include "common/describe/printable.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

using Inside = std::function<bool(const Eigen::Vector3d&)>;

constexpr double kEnd = 0.1;  // of the extent: what "below:z" takes

Eigen::Vector3d three(const std::vector<double>& numbers, int from) {
  return Eigen::Vector3d(numbers.data() + from);
}

bool is_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return (low.array() <= high.array()).all();
}

Inside half_space(const Eigen::Vector3d& normal, double end) {
  return [=](const Eigen::Vector3d& x) { return normal.dot(x) <= end; };
}

/// "AXIS" or "AXIS:VALUE"; `side` 1: below, -1: above.
std::optional<Inside> parse_end(const std::string& text, double side, const TetMesh& mesh) {
  if (text.empty() || text[0] < 'x' || text[0] > 'z') return {};
  const Eigen::Vector3d normal = side * Eigen::Vector3d::Unit(text[0] - 'x');
  if (text.size() > 1) {
    const auto value = text[1] == ':' ? numbers_of(std::string_view(text).substr(2)) : std::vector<double>{};
    if (value.size() != 1) return {};
    return half_space(normal, side * value[0]);
  }
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Eigen::Vector3d& x : mesh.nodes) low = std::min(low, normal.dot(x)), high = std::max(high, normal.dot(x));
  return half_space(normal, low + kEnd * (high - low));
}

std::optional<Inside> parse_place(const std::string& place, const TetMesh& mesh) {
  const std::size_t colon = place.find(':');
  if (colon == std::string::npos) return {};
  const std::string kind = place.substr(0, colon), rest = place.substr(colon + 1);
  if (kind == "below") return parse_end(rest, 1, mesh);
  if (kind == "above") return parse_end(rest, -1, mesh);
  const std::vector<double> numbers = numbers_of(rest);
  if (numbers.size() != 6) return {};
  const Eigen::Vector3d a = three(numbers, 0), b = three(numbers, 3);
  if (kind == "plane" && b.norm() > 0) return half_space(b, b.dot(a));
  if (kind == "box" && is_box(a, b)) return [=](const Eigen::Vector3d& x) { return is_box(a, x) && is_box(x, b); };
  return {};
}

/// Mesh files have names in quotes.
void check_name(const std::string& text, std::string_view name) {
  const auto is_bad = [](unsigned char c) { return c == '"' || c == '\'' || c == '\\' || c < 32 || c == 127; };
  if (std::ranges::any_of(name, is_bad))
    throw std::runtime_error(
        fmt::format("--group {}: a name has no quotes, backslashes or control characters, which mesh files cannot hold",
                    printable(text)));
}

std::pair<std::string, Inside> parse_group(const std::string& text, const TetMesh& mesh) {
  const std::size_t equals = text.find('=');
  check_name(text, std::string_view(text).substr(0, equals));
  if (equals != std::string::npos && equals > 0)
    if (const auto inside = parse_place(text.substr(equals + 1), mesh)) return {text.substr(0, equals), *inside};
  throw std::runtime_error(
      fmt::format("--group {}: NAME=PLACE is asked for, PLACE being box:x,y,z,x,y,z or plane:x,y,z,nx,ny,nz or "
                  "below:AXIS or above:AXIS or below:AXIS:VALUE or above:AXIS:VALUE, in metres",
                  text));
}

}  // namespace

std::vector<double> numbers_of(std::string_view text, char between) {
  std::vector<double> numbers;
  while (true) {
    const std::string_view word = text.substr(0, text.find(between));
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return {};
    numbers.push_back(value);
    if (word.size() == text.size()) return numbers;
    text.remove_prefix(word.size() + 1);
  }
}

FinePlace parse_fine_place(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos) {
    const auto place = numbers_of(std::string_view(text).substr(0, colon)),
               edge = numbers_of(std::string_view(text).substr(colon + 1));
    if (edge.size() == 1 && edge[0] > 0) {
      if (place.size() == 4 && place[3] >= 0) return {three(place, 0), three(place, 0), place[3], edge[0]};
      if (place.size() == 6 && is_box(three(place, 0), three(place, 3)))
        return {three(place, 0), three(place, 3), 0, edge[0]};
    }
  }
  throw std::runtime_error(
      fmt::format("--fine {}: a ball as x,y,z,RADIUS:EDGE or a box as x,y,z,x,y,z:EDGE is asked for, in metres", text));
}

void check_groups(const std::vector<std::string>& texts, const std::vector<std::string>& taken) {
  std::set<std::string> names(taken.begin(), taken.end());
  for (const std::string& text : texts)
    if (!names.insert(parse_group(text, {}).first).second)
      throw std::runtime_error(fmt::format("--group {}: there are two groups of that name", text));
}

void add_group(TetMesh& mesh, const std::string& text) {
  const auto [name, inside] = parse_group(text, mesh);
  MeshGroup group;
  for (const int n : extract_surface(mesh).nodes)
    if (inside(mesh.nodes[n])) group.nodes.push_back(n);
  if (group.nodes.empty()) throw std::runtime_error(fmt::format("--group {}: no node of the surface lies there", text));
  mesh.groups.emplace(name, group);
}

Eigen::Vector3d farthest_from_group(const std::string& text, const std::vector<Eigen::Vector3d>& surface) {
  const auto [name, inside] = parse_group(text, {surface, {}, {}});
  Eigen::Vector3d all = Eigen::Vector3d::Zero(), held = all;
  int count = 0;
  for (const Eigen::Vector3d& x : surface) {
    all += x / static_cast<double>(surface.size());
    if (inside(x)) held += x, ++count;
  }
  if (count == 0) throw std::runtime_error(fmt::format("--group {}: nothing of the surface lies there", text));
  const Eigen::Vector3d away = all - held / count;
  return *std::ranges::max_element(surface, {}, [&](const Eigen::Vector3d& x) { return away.dot(x); });
}

}  // namespace palpate
