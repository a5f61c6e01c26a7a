#include "common/view/instrument.hpp"

#include <cmath>
#include <numbers>

namespace palpate {
namespace {

constexpr int kAround = 48;  // vertices around the shaft

/// A point of the outline that turns about the shaft: position along it, radius, and the outward normal
/// there.
struct OutlinePoint {
  double z, r, normal_z, normal_r;
};

/// From the tip to the hinge: a sphere, then a neck that runs into the shaft without an edge.
std::vector<OutlinePoint> tip_outline(double tip_radius, double shaft_radius, double hinge) {
  std::vector<OutlinePoint> outline;
  constexpr int cap_steps = 14, neck_steps = 12;
  const double cap_end = std::numbers::pi / 180 * (shaft_radius < tip_radius ? 115 : 80);
  for (int i = 0; i <= cap_steps; ++i) {
    const double angle = cap_end * i / cap_steps;
    const double c = std::cos(angle), s = std::sin(angle);
    outline.push_back({tip_radius * c, tip_radius * s, c, s});
  }
  const OutlinePoint start = outline.back();
  const double length = 0.6 * (start.z + hinge);
  const double slope = length * start.normal_z / start.normal_r;  // dr per unit of t, which runs towards -z
  for (int i = 1; i <= neck_steps; ++i) {
    const double t = static_cast<double>(i) / neck_steps;
    const double h = (1 + 2 * t) * (1 - t) * (1 - t), g = t * (1 - t) * (1 - t);
    const double dh = 6 * t * (t - 1), dg = (1 - t) * (1 - 3 * t);
    const double r = h * start.r + g * slope + (1 - h) * shaft_radius;
    const double dr = (dh * (start.r - shaft_radius) + dg * slope) / length;  // towards -z
    const double norm = std::hypot(dr, 1.0);
    outline.push_back({start.z - t * length, r, dr / norm, 1 / norm});
  }
  outline.push_back({-hinge, shaft_radius, 0, 1});
  return outline;
}

/// Turns an outline (from tip to handle) about z over [from, from + sweep].
void revolve(InstrumentPart& part, const std::vector<OutlinePoint>& outline, double from, double sweep, int steps) {
  const int first = static_cast<int>(part.position.size());
  for (const OutlinePoint& p : outline)
    for (int j = 0; j <= steps; ++j) {
      const double angle = from + sweep * j / steps;
      const double c = std::cos(angle), s = std::sin(angle);
      part.position.emplace_back(p.r * c, p.r * s, p.z);
      part.normal.emplace_back(p.normal_r * c, p.normal_r * s, p.normal_z);
    }
  const int rows = static_cast<int>(outline.size());
  for (int i = 0; i + 1 < rows; ++i)
    for (int j = 0; j < steps; ++j) {
      const int a = first + i * (steps + 1) + j, b = a + steps + 1;
      part.triangles.push_back({a, b, b + 1});
      part.triangles.push_back({a, b + 1, a + 1});
    }
}

/// The flat inner face of a jaw, in the plane y = 0; `side` +1 for the upper jaw, whose face looks to -y.
void close_jaw(InstrumentPart& part, const std::vector<OutlinePoint>& outline, int side) {
  const int first = static_cast<int>(part.position.size());
  for (const OutlinePoint& p : outline)
    for (const double x : {-p.r, p.r}) {
      part.position.emplace_back(x, 0, p.z);
      part.normal.emplace_back(0, -side, 0);
    }
  for (int i = 0; i + 1 < static_cast<int>(outline.size()); ++i) {
    const int left = first + 2 * i, right = left + 1, left2 = left + 2, right2 = left + 3;
    if (side < 0) {
      part.triangles.insert(part.triangles.end(), {{left, right, right2}, {left, right2, left2}});
    } else {
      part.triangles.insert(part.triangles.end(), {{left, right2, right}, {left, left2, right2}});
    }
  }
}

/// Presses what has been turned about z flat along x, to `share` of its depth.
void flatten(InstrumentPart& part, float share) {
  for (auto& p : part.position) p.x() *= share;
  for (auto& n : part.normal) n = Eigen::Vector3f(n.x() / share, n.y(), n.z()).normalized();
}

/// A flat electrode with a round end, which ends where the ball that touches does, and the insulator that holds it.
void add_electrode(InstrumentShape& shape, const InstrumentView& view) {
  constexpr float kThickness = 0.3;  // of the width
  const double wide = 0.8 * view.tip_radius, rod = 0.4 * wide, round = view.tip_radius - wide, pi = std::numbers::pi;
  const double shoulder = -0.55 * shape.hinge, collar = 0.85 * view.shaft_radius, hinge = -shape.hinge;
  std::vector<OutlinePoint> outline;
  constexpr int cap_steps = 12, neck_steps = 8;
  for (int i = 0; i <= cap_steps; ++i) {
    const double c = std::cos(pi / 2 * i / cap_steps), s = std::sin(pi / 2 * i / cap_steps);
    outline.push_back({round + wide * c, wide * s, c, s});
  }
  for (int i = 0; i <= neck_steps; ++i) {
    const double t = static_cast<double>(i) / neck_steps, length = 1.5 * wide, drop = wide - rod;
    const double slope = 0.5 * pi * drop / length * std::sin(pi * t), norm = std::hypot(slope, 1.0);
    outline.push_back({-wide - t * length, rod + 0.5 * drop * (1 + std::cos(pi * t)), -slope / norm, 1 / norm});
  }
  outline.push_back({shoulder, rod, 0, 1});
  revolve(shape.parts[1], outline, 0, 2 * pi, kAround);
  flatten(shape.parts[1], kThickness);
  revolve(shape.parts[2], {{shoulder, 0, 1, 0}, {shoulder, collar, 1, 0}}, 0, 2 * pi, kAround);
  revolve(shape.parts[2], {{shoulder, collar, 0, 1}, {hinge, collar, 0, 1}}, 0, 2 * pi, kAround);
}

}  // namespace

InstrumentShape make_instrument(const InstrumentView& view) {
  if (view.jaw_length > 0) return make_forceps(view);
  InstrumentShape shape;
  shape.hinge = std::min(5.0 * std::max(view.tip_radius, view.shaft_radius), 0.8 * view.shaft_length);
  const auto tip = tip_outline(view.tip_radius, view.shaft_radius, shape.hinge);
  const double pi = std::numbers::pi;

  InstrumentPart& shaft = shape.parts[0];
  const double r = view.shaft_radius;
  revolve(shaft, {{-shape.hinge, 0, 1, 0}, {-shape.hinge, r, 1, 0}}, 0, 2 * pi, kAround);
  revolve(shaft, {{-shape.hinge, r, 0, 1}, {-view.shaft_length, r, 0, 1}}, 0, 2 * pi, kAround);
  revolve(shaft, {{-view.shaft_length, r, -1, 0}, {-view.shaft_length, 0, -1, 0}}, 0, 2 * pi, kAround);
  if (view.blade) {
    add_electrode(shape, view);
    return shape;
  }
  for (const int side : {1, -1}) {
    InstrumentPart& jaw = shape.parts[side > 0 ? 1 : 2];
    revolve(jaw, tip, side > 0 ? 0 : pi, pi, kAround / 2);
    close_jaw(jaw, tip, side);
  }
  return shape;
}

Eigen::Isometry3d part_pose(const InstrumentView& view, const InstrumentShape& shape, int part) {
  if (part == 0) return view.tip;
  // A turn about x by a negative angle carries +z towards +y.
  const double angle = (part == 1 ? -0.5 : 0.5) * view.jaw_opening;
  const Eigen::Vector3d hinge(0, 0, -shape.hinge);
  return view.tip * Eigen::Translation3d(hinge) * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()) *
         Eigen::Translation3d(-hinge);
}

}  // namespace palpate
