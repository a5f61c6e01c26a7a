#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "ros_bridge/ros_node.hpp"

namespace palpate::ros {

/// A body's surface as a visualization_msgs/Marker on /palpate/NAME/surface, which rviz shows at once: its triangles in
/// the world frame, each with the places of its three corners.
class BodyTopic {
 public:
  BodyTopic(Node& node, const std::string& body, const std::array<double, 3>& colour);

  /// Whether somebody looks: a surface takes 72 bytes a triangle.
  bool wanted() const { return surface_.readers() > 0; }
  /// `position` [m] per surface node from `origin` on, `triangles` of them; `wall_ns`: of the haptic step that is
  /// shown, CLOCK_REALTIME.
  void tell(const Eigen::Vector3d& origin, std::span<const Eigen::Vector3f> position,
            std::span<const std::array<int, 3>> triangles, std::int64_t wall_ns);

 private:
  std::string body_;
  std::array<double, 3> colour_;  ///< linear RGB
  PlainWriter surface_;
};

}  // namespace palpate::ros
