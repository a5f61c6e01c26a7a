#include "ros_bridge/body_topic.hpp"

#include "ros_bridge/convert.hpp"
#include "ros_bridge/tool_topics.hpp"

namespace palpate::ros {
namespace {

constexpr std::int32_t kTriangleList = 11;  // Marker's type

/// Strings of a marker that are not used.
void leave_empty(visualization_msgs_msg_dds__Marker_& marker) {
  marker.texture_resource = marker.text = marker.mesh_resource = marker.mesh_file.filename = lend("");
  marker.texture.header.frame_id = marker.texture.format = lend("");
}

}  // namespace

BodyTopic::BodyTopic(Node& node, const std::string& body, const std::array<double, 3>& colour)
    : body_(body),
      colour_(colour),
      surface_(
          node.publisher("/palpate/" + allowed_name(body) + "/surface", visualization_msgs_msg_dds__Marker__desc)) {}

void BodyTopic::tell(const Eigen::Vector3d& origin, std::span<const Eigen::Vector3f> position,
                     std::span<const std::array<int, 3>> triangles, std::int64_t wall_ns) {
  std::vector<geometry_msgs_msg_dds__Point_> corners;
  corners.reserve(3 * triangles.size());
  for (const auto& triangle : triangles)
    for (const int node : triangle) {
      const Eigen::Vector3d at = origin + position[node].cast<double>();
      corners.push_back({at.x(), at.y(), at.z()});
    }
  visualization_msgs_msg_dds__Marker_ marker{};
  leave_empty(marker);
  marker.header = header(wall_ns, kWorld);
  marker.ns = lend(body_);
  marker.type = kTriangleList;
  marker.pose.orientation.w = 1;
  marker.scale = {1, 1, 1};
  marker.color = {static_cast<float>(colour_[0]), static_cast<float>(colour_[1]), static_cast<float>(colour_[2]), 1};
  lend(corners, marker.points);
  surface_.write(&marker);
}

}  // namespace palpate::ros
