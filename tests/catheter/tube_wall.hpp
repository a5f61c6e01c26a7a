#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "common/models/catheter/catheter_body.hpp"

namespace palpate {

/// A duct for tests: a tube of rings of triangles about an axis curve, with smooth made-up modes that it
/// integrates itself.
class TubeWall : public DuctWall {
 public:
  struct Shape {
    double radius = 4.5e-3;  ///< [m]
    double length = 0.04;    ///< [m] along the axis
    double bend = 0;         ///< [1/m] curvature of the axis in the x-z plane
    double half_thickness = 0.5e-3;
    int around = 24, rings = 33;
    bool twisted = true;  ///< every other ring by half a triangle; else a prism, flat where x or y is largest
    int modes = 0;
    double frequency = 1500;  ///< [rad/s] of the lowest mode
    double residual = 0;      ///< [m/N]
  };

  explicit TubeWall(const Shape& shape) : shape_(shape), map_(make_map(shape)), surface_(map_, 2e-3) {
    inverse_.assign(shape.modes, 0.0);
    free_.assign(shape.modes, 0.0);
    coordinate_.assign(shape.modes, 0.0);
    velocity_.assign(shape.modes, 0.0);
    make_modes();
    std::vector<int> first, last;
    for (int k = 0; k < shape.around; ++k) {
      first.push_back(k);
      last.push_back((shape.rings - 1) * shape.around + k);
    }
    mouths_ = {first, last};
    plan();
  }

  const TouchSurface& surface() const override { return surface_; }
  double half_thickness() const override { return shape_.half_thickness; }
  std::span<const double> free_motion() const override { return free_; }
  std::span<const double> inverse() const override { return inverse_; }
  Eigen::Matrix3d residual(const Anchor&) const override { return shape_.residual * Eigen::Matrix3d::Identity(); }
  std::span<const std::vector<int>> mouths() const override { return mouths_; }
  void rows(const Anchor& anchor, double* rows) const override {
    for (int axis = 0; axis < 3; ++axis)
      for (int m = 0; m < shape_.modes; ++m) {
        double value = 0;
        for (int v = 0; v < 3; ++v) value += anchor.weights[v] * mode_[(3 * anchor.nodes[v] + axis) * shape_.modes + m];
        rows[axis * shape_.modes + m] = value;
      }
  }

  /// Backward Euler of the modes under the forces; the surface follows.
  void advance(std::span<const WallForce> forces) {
    std::vector<double> row(3 * shape_.modes);
    std::vector<double> y = free_;
    for (const WallForce& f : forces) {
      rows(f.anchor, row.data());
      for (int m = 0; m < shape_.modes; ++m)
        for (int axis = 0; axis < 3; ++axis) y[m] += inverse_[m] * row[axis * shape_.modes + m] * f.force[axis];
    }
    for (int m = 0; m < shape_.modes; ++m) {
      coordinate_[m] += y[m];
      velocity_[m] = y[m] / kStep;
    }
    plan();
    move();
  }

  /// Moves the nodes to rest + modes + `given(rest)`, where a motion is given.
  void move() {
    surface_.begin_update();
    for (int n = 0; n < map_.size(); ++n) surface_.mark_node(n);
    std::vector<double> u;
    const auto coordinates = Eigen::Map<const Eigen::VectorXd>(coordinate_.data(), shape_.modes);
    for (const int n : surface_.marked()) {
      const Eigen::Vector3d by_hand = given ? given(map_.position[n]) : Eigen::Vector3d::Zero();
      for (int axis = 0; axis < 3; ++axis) {
        const double* row = mode_.data() + (3 * n + axis) * static_cast<std::size_t>(shape_.modes);
        u.push_back(by_hand[axis] + Eigen::Map<const Eigen::VectorXd>(row, shape_.modes).dot(coordinates));
      }
    }
    surface_.move_marked(u);
  }

  /// Sets a mode's velocity so that the node which it moves most goes at `speed` [m/s].
  void kick(int mode, double speed) {
    double most = 0;
    for (int k = 0; k < 3 * map_.size(); ++k)
      most = std::max(most, std::abs(mode_[k * static_cast<std::size_t>(shape_.modes) + mode]));
    velocity_[mode] = speed / most;
    plan();
  }

  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> given;
  const std::vector<double>& coordinates() const { return coordinate_; }
  const std::vector<double>& modal_velocity() const { return velocity_; }
  const SurfaceMap& map() const { return map_; }
  double energy() const {
    double e = 0;
    for (int m = 0; m < shape_.modes; ++m)
      e += 0.5 * velocity_[m] * velocity_[m] + 0.5 * omega_[m] * omega_[m] * coordinate_[m] * coordinate_[m];
    return e;
  }

  /// Point of the axis curve at an arc length, and the tangent there.
  static Eigen::Vector3d axis(const Shape& shape, double s) {
    if (shape.bend == 0) return {0, 0, s};
    return {(1 - std::cos(shape.bend * s)) / shape.bend, 0, std::sin(shape.bend * s) / shape.bend};
  }

  static constexpr double kStep = 1e-3;

 private:
  static SurfaceMap make_map(const Shape& shape) {
    SurfaceMap map;
    for (int i = 0; i < shape.rings; ++i) {
      const double s = shape.length * i / (shape.rings - 1), turn = shape.bend * s;
      const Eigen::Vector3d x(std::cos(turn), 0, -std::sin(turn)), y = Eigen::Vector3d::UnitY();
      for (int k = 0; k < shape.around; ++k) {
        const double angle = 2 * std::numbers::pi * (k + 0.5 * (shape.twisted ? i % 2 : 1)) / shape.around;
        map.position.push_back(axis(shape, s) + shape.radius * (std::cos(angle) * x + std::sin(angle) * y));
      }
    }
    for (int i = 0; i + 1 < shape.rings; ++i)
      for (int k = 0; k < shape.around; ++k) {
        const int next = (k + 1) % shape.around, a = i * shape.around, b = a + shape.around;
        if (i % 2 == 0) {
          map.triangles.push_back({a + k, a + next, b + k});
          map.triangles.push_back({a + next, b + next, b + k});
        } else {
          map.triangles.push_back({a + k, b + next, b + k});
          map.triangles.push_back({a + k, a + next, b + next});
        }
      }
    map.touchable = map.size();
    map.fixed.assign(map.size(), {false, false, false});
    for (int n = 0; n < map.size(); ++n) map.node_number.push_back(n);
    return map;
  }

  /// Mode m: waves along and around, the far end held; normalised to the mass of a wet wall.
  void make_modes() {
    const int r = shape_.modes;
    mode_.assign(3 * map_.size() * static_cast<std::size_t>(r), 0.0);
    const double mass =
        1000 * 2 * shape_.half_thickness * 2 * std::numbers::pi * shape_.radius * shape_.length / map_.size();
    for (int m = 0; m < r; ++m) {
      const int along = 1 + m / 10, wave = (m / 2) % 5;
      double sum = 0;
      for (int n = 0; n < map_.size(); ++n) {
        const int ring = n / shape_.around;
        const double angle =
            2 * std::numbers::pi * (n % shape_.around + 0.5 * (shape_.twisted ? ring % 2 : 1)) / shape_.around;
        const double shape = std::sin((along - 0.5) * std::numbers::pi * (1 - double(ring) / (shape_.rings - 1)));
        const double share = shape * (m % 2 ? std::sin(wave * angle + 0.1 * m) : std::cos(wave * angle));
        const Eigen::Vector3d out =
            (map_.position[n] - axis(shape_, shape_.length * ring / (shape_.rings - 1))).normalized();
        const Eigen::Vector3d side = m % 3 == 2 ? Eigen::Vector3d::UnitX() : out;
        for (int axis = 0; axis < 3; ++axis) {
          mode_[(3 * n + axis) * static_cast<std::size_t>(r) + m] = share * side[axis];
          sum += mass * share * side[axis] * share * side[axis];
        }
      }
      for (int k = 0; k < 3 * map_.size(); ++k) mode_[k * static_cast<std::size_t>(r) + m] /= std::sqrt(sum);
      omega_.push_back(shape_.frequency * (1 + 0.15 * m));
    }
  }

  void plan() {
    const double damping_ratio = 0.2;
    for (int m = 0; m < shape_.modes; ++m) {
      const double stiffness = 1 / (kStep * kStep) + 2 * damping_ratio * omega_[m] / kStep + omega_[m] * omega_[m];
      inverse_[m] = 1 / stiffness;
      free_[m] = (velocity_[m] / kStep - omega_[m] * omega_[m] * coordinate_[m]) / stiffness;
    }
  }

  Shape shape_;
  SurfaceMap map_;
  TouchSurface surface_;
  std::vector<std::vector<int>> mouths_;
  std::vector<double> mode_, omega_, inverse_, free_, coordinate_, velocity_;
};

/// Whether p lies in the tube closed by fans over its mouths, by the parity of crossings along a ray.
inline bool enclosed(const Eigen::Vector3d& p, const TubeWall& wall) {
  const Eigen::Vector3d along = Eigen::Vector3d(0.5377, 0.3189, 0.7804).normalized();
  int crossings = 0;
  const auto count = [&](const Triangle& c) {
    const Eigen::Vector3d e1 = c[1] - c[0], e2 = c[2] - c[0], h = along.cross(e2), s = p - c[0], q = s.cross(e1);
    const double det = e1.dot(h), u = s.dot(h) / det, v = along.dot(q) / det;
    crossings += u >= 0 && v >= 0 && u + v <= 1 && e2.dot(q) / det > 0;
  };
  for (int t = 0; t < wall.surface().triangle_count(); ++t) count(wall.surface().corners(t));
  const auto nodes = wall.surface().positions();
  for (const auto& loop : wall.mouths()) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const int node : loop) middle += nodes[node] / loop.size();
    for (std::size_t i = 0; i < loop.size(); ++i) count({middle, nodes[loop[i]], nodes[loop[(i + 1) % loop.size()]]});
  }
  return crossings % 2 == 1;
}

/// [m] from p to the fans over the mouths.
inline double from_mouths(const Eigen::Vector3d& p, const TubeWall& wall) {
  const auto nodes = wall.surface().positions();
  double squared = 1;
  for (const auto& loop : wall.mouths()) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const int node : loop) middle += nodes[node] / loop.size();
    for (std::size_t i = 0; i < loop.size(); ++i)
      squared = std::min(
          squared, closest_point(p, {middle, nodes[loop[i]], nodes[loop[(i + 1) % loop.size()]]}).squared_distance);
  }
  return std::sqrt(squared);
}

/// Particles that are on the wrong side of the wall, those apart that are half in and half out of a mouth.
struct WrongSide {
  int outside = 0;  ///< led in, and not in the tube
  int strayed = 0;  ///< not led in, and in the tube
};
inline WrongSide wrong_side(const CatheterBody& body, const TubeWall& wall) {
  WrongSide wrong;
  for (int i = 0; i < body.size(); ++i) {
    const Eigen::Vector3d& p = body.positions()[i];
    const bool led_in = body.inside()[i] != 0;
    if (led_in == enclosed(p, wall) || from_mouths(p, wall) < body.radius()) continue;
    ++(led_in ? wrong.outside : wrong.strayed);
  }
  return wrong;
}

/// Particles whose flag differs from where they are.
inline int misplaced(const CatheterBody& body, const TubeWall& wall) {
  int count = 0;
  for (int i = 0; i < body.size(); ++i) count += body.inside()[i] != enclosed(body.positions()[i], wall);
  return count;
}

}  // namespace palpate
