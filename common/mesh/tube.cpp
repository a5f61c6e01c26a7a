#include "common/mesh/tube.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "common/geometry/direction.hpp"

namespace palpate {

using Eigen::Vector3d;
using Eigen::Vector3f;

TubeSurface::TubeSurface(int particles, double radius, const Vector3d& axis) : particles_(particles), radius_(radius) {
  if (particles < 2) throw std::runtime_error("a tube needs at least two particles");
  if (!(radius > 0)) throw std::runtime_error("a tube's radius must be positive");
  if (!(axis.norm() > 0)) throw std::runtime_error("a tube's axis must not be zero");
  axis_ = axis.normalized();
  across_ = axis_.unitOrthogonal();
  const int last = vertices() - 1;
  const auto at = [](int ring, int k) { return 1 + ring * kAround + k % kAround; };
  for (int k = 0; k < kAround; ++k) triangles_.push_back({0, at(0, k + 1), at(0, k)});
  for (int ring = 0; ring + 1 < rings(); ++ring)
    for (int k = 0; k < kAround; ++k) {
      triangles_.push_back({at(ring, k), at(ring, k + 1), at(ring + 1, k)});
      triangles_.push_back({at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k)});
    }
  for (int k = 0; k < kAround; ++k) triangles_.push_back({last, at(rings() - 1, k), at(rings() - 1, k + 1)});
}

/// Place and direction of the spline at a sample, and the frame carried over from the last one.
TubeSurface::Frame TubeSurface::frame_at(std::span<const Vector3d> x, int sample, const Frame& last) const {
  const int i = std::min(sample / kRings, particles_ - 2);
  const double t = static_cast<double>(sample - i * kRings) / kRings;
  const Vector3d &b = x[i], &c = x[i + 1];
  const Vector3d from = i > 0 ? Vector3d(0.5 * (c - x[i - 1])) : Vector3d(c - b);
  const Vector3d to = i + 2 < particles_ ? Vector3d(0.5 * (x[i + 2] - b)) : Vector3d(c - b);
  const Vector3d square = 3 * (c - b) - 2 * from - to, cube = from + to - 2 * (c - b);
  Frame frame;
  frame.centre = b + t * (from + t * (square + t * cube));
  const Vector3d slope = from + t * (2 * square + 3 * t * cube);
  const double length = slope.norm();
  frame.along = length > 1e-12 ? Vector3d(slope / length) : last.along;
  // The smallest rotation that takes the last direction to this one.
  frame.across = turn_between(last.along, frame.along) * last.across;
  frame.across = (frame.across - frame.along * frame.along.dot(frame.across)).normalized();
  return frame;
}

/// A ring of `share` of the radius, `shift` [m] ahead of the frame; its normals lean by as much as the cap's.
void TubeSurface::put_ring(int ring, const Frame& frame, double shift, double share, std::span<Vector3f> positions,
                           std::span<Vector3f> normals) const {
  const Vector3d up = frame.along.cross(frame.across);
  for (int k = 0; k < kAround; ++k) {
    const double angle = 2 * std::numbers::pi * k / kAround;
    const Vector3d out =
        share * (std::cos(angle) * frame.across + std::sin(angle) * up) + shift / radius_ * frame.along;
    positions[1 + ring * kAround + k] = (frame.centre + radius_ * out).cast<float>();
    normals[1 + ring * kAround + k] = out.cast<float>();
  }
}

void TubeSurface::place(std::span<const Vector3d> x, std::span<Vector3f> positions, std::span<Vector3f> normals) const {
  Frame frame{.centre = x[0], .along = axis_, .across = across_};
  const int samples = (particles_ - 1) * kRings + 1;
  const auto cap = [&](int ring, int step,
                       double sign) {  // step kCapRings would be the tube's own end ring, 0 the pole
    const double angle = 0.5 * std::numbers::pi * step / (kCapRings + 1);
    put_ring(ring, frame, sign * radius_ * std::cos(angle), std::sin(angle), positions, normals);
  };
  const auto pole = [&](int vertex, double sign) {
    positions[vertex] = (frame.centre + sign * radius_ * frame.along).cast<float>();
    normals[vertex] = (sign * frame.along).cast<float>();
  };
  for (int sample = 0; sample < samples; ++sample) {
    frame = frame_at(x, sample, frame);
    if (sample == 0) {
      pole(0, -1);
      for (int step = 1; step <= kCapRings; ++step) cap(step - 1, step, -1);
    }
    put_ring(kCapRings + sample, frame, 0, 1, positions, normals);
  }
  for (int step = kCapRings; step >= 1; --step) cap(rings() - step, step, 1);
  pole(vertices() - 1, 1);
}

}  // namespace palpate
