#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/mesh/normals.hpp"
#include "common/view/instrument.hpp"

namespace palpate {
namespace {

using Point = Eigen::Vector3f;

/// A patch with smooth normals: rows x columns points, each cell split in two; looks to where the turn from "next row"
/// to "next column" points.
template <class F>
void add_patch(InstrumentPart& part, int rows, int columns, F&& point) {
  InstrumentPart patch;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) patch.position.push_back(point(i, j));
  const auto add = [&](int a, int b, int c) {
    const auto& p = patch.position;
    if ((p[b] - p[a]).cross(p[c] - p[a]).norm() > 1e-12f) patch.triangles.push_back({a, b, c});
  };
  for (int i = 0; i + 1 < rows; ++i)
    for (int j = 0; j + 1 < columns; ++j) {
      const int a = i * columns + j, b = a + columns;
      add(a, b, b + 1);
      add(a, b + 1, a + 1);
    }
  patch.normal.resize(patch.position.size());
  vertex_normals(patch.position, patch.triangles, patch.normal);
  const int first = static_cast<int>(part.position.size());
  part.position.insert(part.position.end(), patch.position.begin(), patch.position.end());
  part.normal.insert(part.normal.end(), patch.normal.begin(), patch.normal.end());
  for (const auto& [a, b, c] : patch.triangles) part.triangles.push_back({first + a, first + b, first + c});
}

/// A flat cap: fan of a convex outline that turns counterclockwise as seen from outside.
void add_cap(InstrumentPart& part, const std::vector<Point>& outline) {
  Point middle = Point::Zero();
  for (const Point& p : outline) middle += p / static_cast<float>(outline.size());
  const int n = static_cast<int>(outline.size());
  add_patch(part, 2, n + 1, [&](int i, int j) { return i == 0 ? middle : outline[j % n]; });
}

/// What a convex outline in the (y, z) plane, counterclockwise as seen from +x, sweeps from x0 to x1 > x0.
void add_prism(InstrumentPart& part, const std::vector<Eigen::Vector2f>& outline, float x0, float x1) {
  const int n = static_cast<int>(outline.size());
  const auto at = [&](float x, int j) { return Point(x, outline[j % n].x(), outline[j % n].y()); };
  std::vector<Point> front, back;
  for (int j = 0; j < n; ++j) {
    front.push_back(at(x1, j));
    back.push_back(at(x0, n - 1 - j));
    add_patch(part, 2, 2, [&](int i, int k) { return at(i == 0 ? x1 : x0, j + k); });
  }
  add_cap(part, front);
  add_cap(part, back);
}

/// A solid of revolution about z: corners (z, r) from front to back; edges stay sharp.
void add_turned(InstrumentPart& part, const std::vector<Eigen::Vector2f>& corners) {
  constexpr int around = 40;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k)
    add_patch(part, 2, around + 1, [&](int i, int j) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(j % around) / around;
      const Eigen::Vector2f& c = corners[k + i];
      return Point(c.y() * std::cos(angle), c.y() * std::sin(angle), c.x());
    });
}

/// Shaft, and the fork that holds the jaws: two cheeks with a pin across at the hinge.
InstrumentPart make_shaft(float radius, float length) {
  InstrumentPart part;
  add_turned(part, {{-1.6f * radius, 0},
                    {-1.6f * radius, 0.86f * radius},
                    {-1.9f * radius, radius},
                    {-length, radius},
                    {-length, 0}});
  std::vector<Eigen::Vector2f> cheek{{-0.5f * radius, -1.8f * radius}, {0.5f * radius, -1.8f * radius}};
  for (int k = 0; k <= 12; ++k) {
    const float angle = std::numbers::pi_v<float> * static_cast<float>(k) / 12;
    cheek.emplace_back(0.5f * radius * std::cos(angle), 0.5f * radius * std::sin(angle));
  }
  add_prism(part, cheek, 0.5f * radius, 0.85f * radius);
  add_prism(part, cheek, -0.85f * radius, -0.5f * radius);
  std::vector<Eigen::Vector2f> pin;
  for (int k = 0; k < 16; ++k) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / 16;
    pin.emplace_back(0.26f * radius * std::cos(angle), 0.26f * radius * std::sin(angle));
  }
  add_prism(part, pin, -0.93f * radius, 0.93f * radius);
  return part;
}

/// A section across the upper jaw, in units of its radius but for the half width at the hinge.
struct Section {
  float z, width, top, bite;  ///< [m] half width; y of the back; y of the biting face
};

/// From behind the hinge to the rounded nose. The teeth's tops touch what the jaw's capsule touches.
std::vector<Section> jaw_sections(float radius, float length, float shaft) {
  std::vector<Section> sections;
  const float neck = std::min(0.45f * shaft, 1.5f * radius), root = 0.5f * shaft,
              begin = std::min(0.9f * shaft, 0.3f * length);
  const auto body = [&](float z, float bite) {
    const float t = std::clamp(z / length, 0.0f, 1.0f), open = std::clamp((z - 0.3f * begin) / begin, 0.0f, 1.0f);
    const float width = neck + (radius * (1.5f - 0.5f * t) - neck) * open * open * (3 - 2 * open);
    sections.push_back({z, width, radius * (1.5f - 0.6f * t), bite});
  };
  body(-root, -0.4f * radius);
  body(0, -0.55f * radius);
  body(0.5f * begin, -0.6f * radius);
  const int teeth = std::max(4, static_cast<int>(std::lround((length - begin) / (0.62f * radius))));
  for (int k = 0; k <= 2 * teeth; ++k)
    body(begin + (length - begin) * static_cast<float>(k) / static_cast<float>(2 * teeth),
         radius * (k % 2 ? -0.97f : -0.68f));
  for (const float turn : {0.4f, 0.8f, 1.15f, 1.4f}) {
    const float shrink = std::cos(turn);
    sections.push_back(
        {length + 0.9f * radius * std::sin(turn), radius * shrink, 0.9f * radius * shrink, -0.68f * radius * shrink});
  }
  return sections;
}

InstrumentPart make_jaw(float radius, float length, float shaft) {
  const std::vector<Section> sections = jaw_sections(radius, length, shaft);
  const int rows = static_cast<int>(sections.size());
  constexpr int arc = 10;  // of the back, between the two flanks
  const auto skin = [&](int i, int j) {
    const Section& s = sections[i];
    if (j == 0) return Point(s.width, s.bite, s.z);
    if (j == arc + 2) return Point(-s.width, s.bite, s.z);
    const float angle = std::numbers::pi_v<float> * static_cast<float>(j - 1) / arc, shoulder = 0.25f * s.top;
    return Point(s.width * std::cos(angle), shoulder + (s.top - shoulder) * std::sin(angle), s.z);
  };
  InstrumentPart jaw;
  add_patch(jaw, rows, arc + 3, [&](int i, int j) { return skin(i, arc + 2 - j); });
  for (int i = 0; i + 1 < rows; ++i)
    add_patch(jaw, 2, 2, [&](int k, int j) { return skin(i + k, j == 0 ? 0 : arc + 2); });
  std::vector<Point> nose, root;
  for (int j = 0; j <= arc + 2; ++j) {
    nose.push_back(skin(rows - 1, j));
    root.push_back(skin(0, arc + 2 - j));
  }
  add_cap(jaw, nose);
  add_cap(jaw, root);
  return jaw;
}

}  // namespace

InstrumentShape make_forceps(const InstrumentView& view) {
  const auto shaft = static_cast<float>(view.shaft_radius);
  InstrumentShape shape;
  shape.parts[0] = make_shaft(shaft, static_cast<float>(view.shaft_length));
  shape.parts[1] = make_jaw(static_cast<float>(view.jaw_radius), static_cast<float>(view.jaw_length), shaft);
  shape.parts[2] = shape.parts[1];  // half a turn about the shaft gives the lower jaw
  for (auto* vectors : {&shape.parts[2].position, &shape.parts[2].normal})
    for (Point& p : *vectors) p.head<2>() *= -1;
  return shape;
}

}  // namespace palpate
