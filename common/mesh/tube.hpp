#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace palpate {

/// Surface of a smooth closed tube about a spline (Catmull and Rom 1974) through particles. The triangles and
/// the number of vertices are fixed by the number of particles; only positions and normals follow the motion.
///
/// Vertices: the tail's pole, rings of kAround from tail to tip (kCapRings of each rounded end among them),
/// the tip's pole. Each ring's frame is carried over from the one before it without turning about the spline,
/// and the first one from the resting direction, so that nothing twists or flips from frame to frame.
class TubeSurface {
 public:
  static constexpr int kAround = 12;
  static constexpr int kRings = 3;     ///< per segment between particles
  static constexpr int kCapRings = 3;  ///< of each end

  /// `axis`: direction from tail to tip at rest, from which the first frame is carried over; only where the
  /// first segment points against it is there no smallest turn to take. Throws std::runtime_error for fewer
  /// than two particles, or a radius or an axis of no length.
  TubeSurface(int particles, double radius, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ());

  int particles() const { return particles_; }
  int vertices() const { return rings() * kAround + 2; }
  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }  ///< outward by the right-hand rule

  /// Vertex positions [m] and outward unit normals for particles at `x` [m]; both spans hold vertices()
  /// entries. Allocates nothing. Particles that coincide leave rings of the full radius.
  void place(std::span<const Eigen::Vector3d> x, std::span<Eigen::Vector3f> positions,
             std::span<Eigen::Vector3f> normals) const;

 private:
  struct Frame {
    Eigen::Vector3d centre, along, across;  ///< [m], unit, unit
  };
  int rings() const { return (particles_ - 1) * kRings + 1 + 2 * kCapRings; }
  Frame frame_at(std::span<const Eigen::Vector3d> x, int sample, const Frame& last) const;
  void put_ring(int ring, const Frame& frame, double shift, double share, std::span<Eigen::Vector3f> positions,
                std::span<Eigen::Vector3f> normals) const;

  int particles_;
  double radius_;
  Eigen::Vector3d axis_, across_;
  std::vector<std::array<int, 3>> triangles_;
};

}  // namespace palpate
