#include "tools/generate/ribs.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kMidline = 0.020;                    // [m] x of the spine; the liver lies mostly right of it
constexpr double kHalfWidth = 0.170, kDepth = 0.118;  // [m] half axes of the chest at the ribs
constexpr double kReach = 112;  // [deg] from the spine to a rib's end: the front is open, where the camera looks in

/// A point of the chest: `angle` [rad] from the spine (0) towards the patient's left (positive) or right.
Vector3d chest(double angle, double height, double scale) {
  const double drop = 0.075 * std::pow(std::sin(angle / 2), 2);  // ribs run down towards the front
  return {kMidline + scale * kHalfWidth * std::sin(angle), scale * kDepth * std::cos(angle), height - drop};
}

void add_triangle(TriangleMesh& mesh, int a, int b, int c) {
  const Vector3d &x = mesh.nodes[a], &y = mesh.nodes[b], &z = mesh.nodes[c];
  if ((y - x).cross(z - x).norm() > 1e-12) mesh.triangles.push_back({a, b, c});
}

void add_grid(TriangleMesh& mesh, int rows, int columns, bool closed, const std::function<Vector3d(int, int)>& point) {
  const int first = static_cast<int>(mesh.nodes.size()), nodes_per_row = closed ? columns : columns + 1;
  for (int r = 0; r <= rows; ++r) {
    for (int c = 0; c < nodes_per_row; ++c) mesh.nodes.push_back(point(r, c));
  }
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const int a = first + r * nodes_per_row + c, b = first + r * nodes_per_row + (c + 1) % nodes_per_row;
      const int d = a + nodes_per_row, e = b + nodes_per_row;
      add_triangle(mesh, a, b, e);
      add_triangle(mesh, a, e, d);
    }
  }
}

/// A tube along `centre(t)`, t in [0, 1], with half axes radii(t) across (x) and along `up` (y), closed at
/// both ends by shrinking there.
void add_tube(TriangleMesh& mesh, int segments, int sides, const Vector3d& up,
              const std::function<Vector3d(double)>& centre, const std::function<Eigen::Vector2d(double)>& radii) {
  add_grid(mesh, segments, sides, true, [&](int r, int c) {
    const double even = static_cast<double>(r) / segments, angle = 2 * std::numbers::pi * c / sides;
    const double t = even - 0.13 * std::sin(2 * std::numbers::pi * even);  // closer rows make the ends round
    const Vector3d along = (centre(t + 1e-4) - centre(t - 1e-4)).normalized();
    const Vector3d across = along.cross(up).normalized(), upright = along.cross(across);
    const double end = std::sqrt(std::max(0.0, 1 - std::pow(std::abs(2 * t - 1), 24)));
    const Eigen::Vector2d radius = end * radii(t);
    return Vector3d(centre(t) + radius.x() * std::cos(angle) * across + radius.y() * std::sin(angle) * upright);
  });
}

void add_rib(TriangleMesh& mesh, double height, double scale, double side) {
  const double begin = 7 * std::numbers::pi / 180, end = kReach * std::numbers::pi / 180;
  add_tube(
      mesh, 30, 7, Vector3d::UnitZ(),
      [&](double t) { return chest(side * (begin + t * (end - begin)), height, scale); },
      [](double t) { return Eigen::Vector2d(0.0038, 0.0060 + 0.0012 * std::sin(std::numbers::pi * t)); });
}

void add_spine(TriangleMesh& mesh) {
  add_tube(
      mesh, 60, 8, Vector3d::UnitX(), [](double t) { return Vector3d(kMidline, kDepth + 0.008, -0.13 + 0.28 * t); },
      [](double t) {
        const double bulge = 0.0016 * std::cos(2 * std::numbers::pi * 9 * t);  // vertebrae and discs
        return Eigen::Vector2d(0.015 + bulge, 0.019 + bulge);
      });
}

/// All around the room that gas makes for the camera, with a dome above and another below, so that it has no edge; from
/// outside it is not drawn.
void add_wall(TriangleMesh& mesh) {
  constexpr int kFloorRows = 4, kRows = 4, kDomeRows = 6, kColumns = 36;
  constexpr double kBlown = 2.8;                                // how much farther the front is than the back
  constexpr double kBottom = -0.40, kTop = 0.17, kDome = 0.15;  // [m]; a dome's height
  add_grid(mesh, kFloorRows + kRows + kDomeRows, kColumns, true, [&](int r, int c) {
    const double angle = 2 * std::numbers::pi * c / kColumns - std::numbers::pi;
    const int row = std::clamp(r - kFloorRows, 0, kRows), beyond = r - kFloorRows - row;  // of the wall; of a dome
    const double up = static_cast<double>(row) / kRows;
    const double risen = std::numbers::pi / 2 * beyond / (beyond < 0 ? kFloorRows : kDomeRows);
    const Vector3d rim = chest(angle, kBottom + (kTop - kBottom) * up, 1.10 - 0.05 * up);
    const Vector3d middle = {kMidline, 0, kBottom + (kTop - kBottom) * up};
    const Vector3d p = middle + std::cos(risen) * (rim - middle) + Vector3d(0, 0, kDome * std::sin(risen));
    return Vector3d(p.x(), p.y() < 0 ? kBlown * p.y() : p.y(), p.z());
  });
}

}  // namespace

TriangleMesh make_ribs() {
  TriangleMesh mesh;
  for (int rib = 0; rib < 5; ++rib) {
    const double height = 0.125 - 0.036 * rib, scale = 0.96 + 0.015 * rib;
    for (double side : {-1.0, 1.0}) add_rib(mesh, height, scale, side);
  }
  add_spine(mesh);
  add_wall(mesh);
  return mesh;
}

}  // namespace palpate
