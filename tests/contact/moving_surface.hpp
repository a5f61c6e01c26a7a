#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "common/geometry/triangle.hpp"
#include "common/mesh/generators.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {

/// A closed surface at two times: a block, 0.1 m across, that bulges and twists, every node a little off its
/// place.
struct MovingSurface {
  explicit MovingSurface(unsigned seed, double motion = 0.002) : random(seed) {
    const TetMesh mesh = make_block({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}, {10, 10, 10});
    const Surface surface = extract_surface(mesh);
    std::vector<int> place(mesh.nodes.size(), -1);
    for (int node : surface.nodes) {
      place[node] = static_cast<int>(rest.size());
      rest.push_back(mesh.nodes[node] + 0.0005 * direction());
    }
    for (const auto& t : surface.triangles) triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
    previous = present = rest;
    step(motion);
    step(motion);
  }

  /// One step: every node goes on to a new deformed place, up to about `motion` [m] away.
  void step(double motion) {
    previous = present;
    const Eigen::Vector3d push = motion * direction(), at = 0.05 * direction();
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const double near = std::exp(-(rest[i] - at).squaredNorm() / 0.0008);
      present[i] = rest[i] + 5 * near * push + 0.1 * motion * direction();
    }
  }

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  Eigen::Vector3d direction() {
    std::normal_distribution<double> normal;
    return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
  }
  int pick(std::size_t count) { return static_cast<int>(random() % count); }
  Triangle before(int t) const { return corners(previous, t); }
  Triangle after(int t) const { return corners(present, t); }
  Triangle corners(const std::vector<Eigen::Vector3d>& x, int t) const {
    return {x[triangles[t][0]], x[triangles[t][1]], x[triangles[t][2]]};
  }
  int size() const { return static_cast<int>(triangles.size()); }

  std::mt19937 random;
  std::vector<Eigen::Vector3d> rest, previous, present;
  std::vector<std::array<int, 3>> triangles;
};

/// The box that a triangle sweeps.
inline std::array<Eigen::Vector3d, 2> swept_box(const Triangle& a, const Triangle& b) {
  std::array<Eigen::Vector3d, 2> box{a[0], a[0]};
  for (const Triangle* t : {&a, &b})
    for (const Eigen::Vector3d& p : *t) box = {box[0].cwiseMin(p), box[1].cwiseMax(p)};
  return box;
}

inline bool meet(const std::array<Eigen::Vector3d, 2>& a, const std::array<Eigen::Vector3d, 2>& b) {
  return (a[0].array() <= b[1].array()).all() && (b[0].array() <= a[1].array()).all();
}

/// Turns of the closed surface around p (1 inside, 0 outside), from solid angles (Van Oosterom and Strackee
/// 1983).
inline double winding(const MovingSurface& surface, const std::vector<Eigen::Vector3d>& x, const Eigen::Vector3d& p) {
  double angle = 0;
  for (int t = 0; t < surface.size(); ++t) {
    const Triangle c = surface.corners(x, t);
    const Eigen::Vector3d a = c[0] - p, b = c[1] - p, d = c[2] - p;
    const double la = a.norm(), lb = b.norm(), ld = d.norm();
    angle += 2 * std::atan2(a.dot(b.cross(d)), la * lb * ld + a.dot(b) * ld + b.dot(d) * la + d.dot(a) * lb);
  }
  return angle / (4 * M_PI);
}

}  // namespace palpate
