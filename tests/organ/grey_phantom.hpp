#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/organ/phantom_image.hpp"

namespace palpate::testing {

/// A made image: an ellipsoid with a bump and, hanging on it by a neck, a ball of nearly its grey value. Grey values
/// are means over each voxel, with noise of a normal distribution.
struct GreyPhantom {
  int x = 96, y = 88, z = 56;
  Eigen::Vector3d voxel_mm{0.9, 0.9, 1.2};
  double neck_mm = 2.5;  ///< its radius
  double noise = 12;     ///< [grey] beside 60 between organ and surroundings
  double shading = 0;    ///< [1] by which one end along y is brighter, and the other one darker

  Eigen::Vector3d place_mm(const Eigen::Vector3d& voxels) const { return voxels.cwiseProduct(voxel_mm); }
  Eigen::Vector3d middle_mm() const { return {0.4 * x * voxel_mm.x(), 0.5 * y * voxel_mm.y(), 0.5 * z * voxel_mm.z()}; }

  /// < 0 in the organ; about a distance [mm].
  double organ(const Eigen::Vector3d& mm) const {
    const Eigen::Array3d axes(0.3 * x * voxel_mm.x(), 0.33 * y * voxel_mm.y(), 0.36 * z * voxel_mm.z());
    const Eigen::Array3d p = (mm - middle_mm()).array();
    const double off = (p / axes).matrix().norm(), ellipsoid = off * (off - 1) / (p / axes.square()).matrix().norm();
    const double bump = (p.matrix() - Eigen::Vector3d(-0.1 * x, -0.28 * y, 0)).norm() - 9;
    return std::min(off < 1e-6 ? -axes.minCoeff() : ellipsoid, bump);
  }
  /// < 0 in the ball and its neck.
  double neighbour(const Eigen::Vector3d& mm) const {
    const Eigen::Vector3d p = mm - middle_mm(), ball(0.45 * x * voxel_mm.x(), 0, 0);
    const double beyond = std::max(-p.x(), p.x() - ball.x());
    return std::min((p - ball).norm() - 10, std::max(beyond, p.tail<2>().norm() - neck_mm));
  }
  double grey_at(const Eigen::Vector3d& mm) const { return organ(mm) < 0 ? 120 : neighbour(mm) < 0 ? 117 : 60; }
  /// Mean over a voxel.
  double grey_of(const Eigen::Vector3d& v) const {
    constexpr int kSub = 3;
    const Eigen::Vector3d middle = place_mm(v);
    if (std::min(std::abs(organ(middle)), std::abs(neighbour(middle))) > 1.5) return grey_at(middle);
    double sum = 0;
    for (int s = 0; s < kSub * kSub * kSub; ++s) {
      const Eigen::Vector3d part(s % kSub, s / kSub % kSub, s / kSub / kSub);
      sum += grey_at(place_mm(v + (part - Eigen::Vector3d::Ones()) / kSub));
    }
    return sum / (kSub * kSub * kSub);
  }

  std::size_t size() const { return static_cast<std::size_t>(x) * y * z; }
  template <class Work>
  void each(const Work& work) const {
    for (int k = 0; k < z; ++k)
      for (int j = 0; j < y; ++j)
        for (int i = 0; i < x; ++i) work(Eigen::Vector3d(i, j, k));
  }

  std::vector<char> truth() const {
    std::vector<char> inside;
    each([&](const Eigen::Vector3d& v) { inside.push_back(organ(place_mm(v)) < 0); });
    return inside;
  }

  std::vector<std::int16_t> grey() const {
    std::vector<std::int16_t> values;
    BellNoise bell;
    each([&](const Eigen::Vector3d& v) {
      const double shade = 1 + shading * (2 * v.y() / y - 1);
      values.push_back(static_cast<std::int16_t>(std::lround(shade * grey_of(v) + noise * bell())));
    });
    return values;
  }

  std::string inr() const {
    std::string text = inr_header({x, y, z}, {voxel_mm.x(), voxel_mm.y(), voxel_mm.z()}, "signed fixed", 16);
    const auto values = grey();
    return text.append(reinterpret_cast<const char*>(values.data()), 2 * values.size());
  }
};

}  // namespace palpate::testing
