#include "tools/organ/hand_contours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "tools/organ/finding.hpp"

namespace palpate {
namespace {

constexpr int kBetween = 8;  // points of the line from one of those drawn to the next
constexpr std::size_t kMostPoints = 2000;
constexpr int kFurthest = 16;  // slices from one that is drawn to the next, for those in between to be drawn too

template <class Number>
std::optional<Number> number_of(const std::string& word) {
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return {};
  return value;
}

/// Adds a line's point to its slice, and says which that is; empty lines have none. Throws std::runtime_error(reason).
std::optional<int> take_line(const std::string& text, const GridShape& shape, HandContours& points) {
  std::istringstream in(text.substr(0, text.find('#')));
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  if (words.empty()) return {};
  if (words.size() != 3) throw std::runtime_error(fmt::format("{} words: SLICE X Y is asked for", words.size()));
  const auto slice = number_of<int>(words[0]);
  if (!slice || *slice < 0 || *slice >= shape.count[2])
    throw std::runtime_error(fmt::format("'{}' is no slice from 0 to {}", words[0], shape.count[2] - 1));
  Eigen::Vector2d point;
  for (int a = 0; a < 2; ++a) {
    const auto value = number_of<double>(words[a + 1]);
    if (!value || !(*value >= 0 && *value <= shape.count[a] - 1))  // false for what is no number
      throw std::runtime_error(
          fmt::format("{} '{}' is no number from 0 to {}, in voxels", "XY"[a], words[a + 1], shape.count[a] - 1));
    point[a] = *value;
  }
  Contour& line = points[*slice];
  if (!line.empty() && line.back() == point) throw std::runtime_error("the same point twice");
  line.push_back(point);
  return slice;
}

/// Whether two lines cross within both.
bool cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, const Eigen::Vector2d& d) {
  const auto side = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r) {
    return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
  };
  return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

/// Throws std::runtime_error(reason).
void check_points(int slice, const Contour& points) {
  const std::size_t n = points.size();
  if (n < 3 || n > kMostPoints)
    throw std::runtime_error(
        fmt::format("slice {} has {} points: a contour has three at least, and {} at most", slice, n, kMostPoints));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j)
      if (cross(points[i], points[i + 1], points[j], points[(j + 1) % n]))
        throw std::runtime_error(fmt::format(
            "the contour in slice {} crosses itself: the line from its point {} to {} meets that from {} to {}; "
            "points are joined in their order, and the last to the first",
            slice, i + 1, i + 2, j + 1, (j + 1) % n + 1));
}

/// Through all points (Catmull and Rom, Computer Aided Geometric Design, 1974), counter-clockwise.
Contour smooth_line(const Contour& points) {
  const std::size_t n = points.size();
  Contour line;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d &a = points[(i + n - 1) % n], &b = points[i], &c = points[(i + 1) % n],
                          &d = points[(i + 2) % n];
    for (int s = 0; s < kBetween; ++s) {
      const double t = static_cast<double>(s) / kBetween;
      line.emplace_back(b + 0.5 * t * ((c - a) + t * ((2 * a - 5 * b + 4 * c - d) + t * (3 * (b - c) + d - a))));
    }
  }
  if (signed_area(line) < 0) std::reverse(line.begin(), line.end());
  return line;
}

DistanceGrid slice_distance(const GridShape& shape, const char* inside) {
  GridShape slice = shape;
  slice.count[2] = 1;
  slice.spacing.z() = shape.spacing.head<2>().maxCoeff();
  return distance_to_border(slice, std::vector<char>(inside, inside + slice.size()));
}

}  // namespace

HandContours read_hand_contours(const std::filesystem::path& file, const GridShape& shape) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(fmt::format("{}: it cannot be opened", file.string()));
  HandContours contours;
  std::map<int, int> last_line;  // of a slice
  int number = 0;
  for (std::string line; std::getline(in, line);) try {
      ++number;
      if (const auto slice = take_line(line, shape, contours)) last_line[*slice] = number;
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("{}:{}: {}", file.string(), number, error.what()));
    }
  if (contours.empty()) throw std::runtime_error(fmt::format("{}: no point stands in it", file.string()));
  for (auto& contour : contours) {
    const int slice = contour.first;
    auto& points = contour.second;
    if (points.size() > 1 && points.front() == points.back()) points.pop_back();
    of_file(fmt::format("{}:{}", file.string(), last_line[slice]), [&] { check_points(slice, points); });
    points = smooth_line(points);
  }
  return contours;
}

void draw_by_hand(const HandContours& contours, const GridShape& shape, std::vector<char>& inside) {
  const std::size_t layer = static_cast<std::size_t>(shape.count[0]) * shape.count[1];
  std::optional<std::pair<int, DistanceGrid>> before;
  for (const auto& [slice, contour] : contours) {
    char* const here = inside.data() + slice * layer;
    fill_contours({contour}, shape.count[0], shape.count[1], here);
    if (std::count(here, here + layer, 1) == 0)
      throw std::runtime_error(fmt::format("the contour drawn in slice {} goes around no voxel's middle", slice));
    std::pair now{slice, slice_distance(shape, here)};
    if (before && slice - before->first <= kFurthest)
      for (int k = before->first + 1; k < slice; ++k) {
        const float part = static_cast<float>(k - before->first) / static_cast<float>(slice - before->first);
        for (std::size_t i = 0; i < layer; ++i)
          inside[k * layer + i] = (1 - part) * before->second.value[i] + part * now.second.value[i] < 0;
      }
    before = std::move(now);
  }
}

}  // namespace palpate
