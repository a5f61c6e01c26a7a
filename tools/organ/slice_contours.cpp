#include "tools/organ/slice_contours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace palpate {
namespace {

constexpr std::array<std::array<int, 2>, 4> kCorner{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

/// From the point where a line enters a cell to the one where it leaves it. Points lie on edges between voxels.
struct Links {
  std::unordered_map<long, long> next;
  std::unordered_map<long, Eigen::Vector2d> place;
  std::vector<long> first;  ///< in the order in which they were met
};

void link_cell(int i, int j, int row, const std::function<double(int, int)>& value, Links& links) {
  std::array<double, 4> v;
  for (int c = 0; c < 4; ++c) v[c] = value(i + kCorner[c][0], j + kCorner[c][1]);
  const auto edge = [&](int e) {  // from corner e to the next one
    const int x = i + (e == 1), y = j + (e == 2);
    return 2 * (static_cast<long>(y + 1) * row + x + 1) + (e % 2);
  };
  const auto point = [&](int e) {
    const int f = (e + 1) % 4;
    const double part = v[e] / (v[e] - v[f]);
    const Eigen::Vector2d a(i + kCorner[e][0], j + kCorner[e][1]), b(i + kCorner[f][0], j + kCorner[f][1]);
    return Eigen::Vector2d(a + part * (b - a));
  };
  for (int e = 0; e < 4; ++e) {
    if (!(v[e] < 0 && v[(e + 1) % 4] >= 0)) continue;
    int back = e;  // the corners before this one that are inside too
    while (v[(back + 3) % 4] < 0) back = (back + 3) % 4;
    links.next[edge(e)] = edge((back + 3) % 4);
    links.place[edge(e)] = point(e);
    links.first.push_back(edge(e));
  }
}

}  // namespace

std::vector<Contour> level_lines(int width, int height, const std::function<double(int, int)>& value) {
  const auto padded = [&](int i, int j) { return i < 0 || j < 0 || i >= width || j >= height ? 1.0 : value(i, j); };
  Links links;
  for (int j = -1; j < height; ++j)
    for (int i = -1; i < width; ++i) link_cell(i, j, width + 2, padded, links);
  std::vector<Contour> lines;
  for (const long first : links.first) {
    Contour line;
    long here = first;
    for (auto at = links.next.find(here); at != links.next.end(); at = links.next.find(here)) {
      line.push_back(links.place[here]);
      here = at->second;
      links.next.erase(at);
    }
    if (!line.empty()) lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<Contour> outlines_of(int width, int height, const char* inside) {
  return level_lines(width, height,
                     [&](int i, int j) { return inside[static_cast<std::size_t>(j) * width + i] ? -1.0 : 1.0; });
}

void fill_contours(const std::vector<Contour>& contours, int width, int height, char* inside) {
  std::vector<std::vector<std::pair<double, int>>> crossings(height);  // of each row: where, and +1 on the way up
  for (const Contour& c : contours)
    for (std::size_t n = 0; n < c.size(); ++n) {
      const Eigen::Vector2d &a = c[n], &b = c[(n + 1) % c.size()];
      const double low = std::min(a.y(), b.y()), high = std::max(a.y(), b.y());
      for (int j = std::max(0, static_cast<int>(std::ceil(low))); j < height && j < high; ++j)
        crossings[j].emplace_back(a.x() + (j - a.y()) / (b.y() - a.y()) * (b.x() - a.x()), b.y() > a.y() ? 1 : -1);
    }
  for (int j = 0; j < height; ++j) {
    std::sort(crossings[j].begin(), crossings[j].end());
    int around = 0;
    auto next = crossings[j].begin();
    for (int i = 0; i < width; ++i) {
      for (; next != crossings[j].end() && next->first <= i; ++next) around -= next->second;
      inside[static_cast<std::size_t>(j) * width + i] = around > 0;
    }
  }
}

Contour resampled(const Contour& contour, double step) {
  double length = 0;
  for (std::size_t n = 0; n < contour.size(); ++n) length += (contour[(n + 1) % contour.size()] - contour[n]).norm();
  const int count = std::max(3, static_cast<int>(std::lround(length / step)));
  Contour even;
  double from = 0;
  for (std::size_t n = 0; n < contour.size(); ++n) {
    const Eigen::Vector2d &a = contour[n], way = contour[(n + 1) % contour.size()] - a;
    const double to = from + way.norm();
    while (static_cast<int>(even.size()) < count && length * static_cast<double>(even.size()) / count < to)
      even.push_back(a + (length * static_cast<double>(even.size()) / count - from) / (to - from) * way);
    from = to;
  }
  while (static_cast<int>(even.size()) < count) even.push_back(contour.front());
  return even;
}

double signed_area(const Contour& contour) {
  double twice = 0;
  for (std::size_t n = 0; n < contour.size(); ++n) {
    const Eigen::Vector2d &a = contour[n], &b = contour[(n + 1) % contour.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

}  // namespace palpate
