#include "common/models/catheter/chain.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void require(bool condition, const char* sentence) {
  if (!condition) throw std::runtime_error(sentence);
}

void check(const Catheter& shape, double young, double density) {
  require(shape.particles >= 3, "a catheter needs at least three particles");
  require((shape.tip - shape.tail).norm() > 0, "the catheter's tip must be away from its tail");
  require(shape.radius > 0, "the catheter's radius must be positive");
  require(young > 0 && density > 0, "the catheter's Young's modulus and density must be positive");
  require(shape.damping >= 0, "the catheter's damping must not be negative");
}

/// Unit tangent of the segment from a to b, and one over its length, which is taken as no less than a fifth
/// of the resting length where the catheter is crushed.
struct Link {
  Link(const Vector3d& a, const Vector3d& b, double spacing) {
    const Vector3d along = b - a;
    length = along.norm();
    tangent = length > 0 ? Vector3d(along / length) : Vector3d::UnitX();
    per_length = 1 / std::max(length, 0.2 * spacing);
  }
  Matrix3d across() const { return Matrix3d::Identity() - tangent * tangent.transpose(); }

  Vector3d tangent;
  double length, per_length;
};

}  // namespace

Chain::Chain(const Catheter& shape, double young, double density) {
  check(shape, young, density);
  const int n = shape.particles;
  const double area = std::numbers::pi * shape.radius * shape.radius;
  spacing_ = (shape.tip - shape.tail).norm() / (n - 1);
  stretching_ = young * area / spacing_;
  bending_ = young * area * shape.radius * shape.radius / 4 / spacing_;
  rest_.resize(n);
  for (int i = 0; i < n; ++i) rest_[i] = shape.tail + (shape.tip - shape.tail) * (double(i) / (n - 1));
  mass_.assign(n, density * area * spacing_);
  mass_.front() /= 2;
  mass_.back() /= 2;
}

void Chain::add_forces(std::span<const Vector3d> x, std::span<Vector3d> force) const {
  Link a(x[0], x[1], spacing_);
  for (int i = 0; i + 1 < size(); ++i) {
    const Link b = i > 0 ? Link(x[i], x[i + 1], spacing_) : a;
    const Vector3d pull = stretching_ * (b.length - spacing_) * b.tangent;
    force[i] += pull;
    force[i + 1] -= pull;
    if (i == 0) continue;
    // The change of t' - t is C' (dx_2 - dx_1) - C (dx_1 - dx_0), C = (I - t t^T) / l.
    const Vector3d turn = b.tangent - a.tangent;
    const Vector3d first = bending_ * a.per_length * (turn - a.tangent * a.tangent.dot(turn));
    const Vector3d last = bending_ * b.per_length * (turn - b.tangent * b.tangent.dot(turn));
    force[i - 1] -= first;
    force[i] += first + last;
    force[i + 1] -= last;
    a = b;
  }
}

void Chain::add_stiffness(std::span<const Vector3d> x, std::span<const double> tension, BandMatrix& stiffness) const {
  Matrix3d ca = Matrix3d::Zero();
  double a_per_length = 0;
  for (int i = 0; i + 1 < size(); ++i) {
    const Link b(x[i], x[i + 1], spacing_);
    const Matrix3d across = b.across();
    const Matrix3d k =
        stretching_ * (Matrix3d::Identity() - across) + std::max(0.0, tension[i]) * b.per_length * across;
    const Matrix3d cb = b.per_length * across, bb = bending_ * b.per_length * cb;
    stiffness.add(i, 0, k);
    stiffness.add(i, 1, -k);
    stiffness.add(i + 1, 0, k);
    if (i > 0) {
      const Matrix3d aa = bending_ * a_per_length * ca, ba = bending_ * cb * ca;
      stiffness.add(i - 1, 0, aa);
      stiffness.add(i - 1, 1, -aa - ba);
      stiffness.add(i - 1, 2, ba);
      stiffness.add(i, 0, aa + bb + ba + ba.transpose());
      stiffness.add(i, 1, -bb - ba);
      stiffness.add(i + 1, 0, bb);
    }
    ca = cb;
    a_per_length = b.per_length;
  }
}

double Chain::tension(int segment, std::span<const Vector3d> x, std::span<const Vector3d> motion) const {
  const Link s(x[segment], x[segment + 1], spacing_);
  return stretching_ * (s.length - spacing_ + s.tangent.dot(motion[segment + 1] - motion[segment]));
}

double Chain::elastic_energy(std::span<const Vector3d> x) const {
  double energy = 0;
  for (int i = 0; i + 1 < size(); ++i) {
    const Link s(x[i], x[i + 1], spacing_);
    energy += 0.5 * stretching_ * (s.length - spacing_) * (s.length - spacing_);
    if (i == 0) continue;
    energy += 0.5 * bending_ * (s.tangent - Link(x[i - 1], x[i], spacing_).tangent).squaredNorm();
  }
  return energy;
}

double Chain::frequency_bound() const {
  // Rows of the two chains' difference operators; at rest they act along and across, so that their sum bounds
  // both.
  double bound = 0;
  for (int i = 0; i < size(); ++i) {
    std::array<double, 5> row{};
    for (int middle = std::max(1, i - 1); middle <= std::min(size() - 2, i + 1); ++middle) {
      const double weight[3] = {1, -2, 1};
      for (int k = 0; k < 3; ++k) row[middle - 1 + k - i + 2] += weight[i - middle + 1] * weight[k];
    }
    double bending = 0;
    for (const double entry : row) bending += std::abs(entry);
    const double stretching = i == 0 || i == size() - 1 ? 2 : 4;
    bound = std::max(bound, (stretching * stretching_ + bending * bending_ / (spacing_ * spacing_)) / mass_[i]);
  }
  return std::sqrt(bound);
}

}  // namespace palpate
