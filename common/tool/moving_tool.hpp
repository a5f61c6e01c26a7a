#pragma once
#include <Eigen/Geometry>
#include <span>

#include "common/tool/instrument.hpp"

namespace palpate {

/// A tool as the contact search sees it: two poses and its spheres.
struct MovingTool {
  Eigen::Isometry3d before = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d now = Eigen::Isometry3d::Identity();
  std::span<const SampleSphere> samples;

  Eigen::Vector3d centre(const Eigen::Isometry3d& pose, int sample) const {
    return pose.translation() - samples[sample].behind * pose.linear().col(2);
  }
};

}  // namespace palpate
