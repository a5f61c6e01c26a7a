#pragma once
#include <string>
#include <vector>

#include "common/bus/plain_topic.hpp"

namespace palpate::ros {

/// The name as ROS allows it in topics and frames: letters, digits and "_", in place of other characters "_", and none
/// of the digits first.
std::string allowed_name(const std::string& name);

/// A node as other ROS 2 nodes know it over rmw_cyclonedds: topics under "rt/", the enclave in the participant's user
/// data, and its endpoints told on ros_discovery_info. Publishers and subscriptions have ROS's default quality of
/// service: reliable, volatile, the newest 10.
class Node {
 public:
  /// Throws std::runtime_error in one sentence.
  Node(const BusSettings& settings, std::string name);

  /// `topic`: "/palpate/probe/pose". It ends with the node.
  PlainWriter publisher(const std::string& topic, const dds_topic_descriptor& type);
  PlainReader subscription(const std::string& topic, const dds_topic_descriptor& type);
  /// Tells the others what it has, also those that come later. Call once, after the last publisher and subscription.
  void announce();
  bool wait(std::chrono::nanoseconds timeout) { return participant_.wait(timeout); }

 private:
  std::string name_;
  PlainParticipant participant_;
  PlainWriter about_;  ///< kept for late joiners
  std::vector<Guid> writers_, readers_;
};

}  // namespace palpate::ros
