#include "ros_bridge/ros_node.hpp"

#include <algorithm>
#include <cctype>

#include "ros_bridge/lend.hpp"

namespace palpate::ros {
namespace {

std::string dds_name(const std::string& topic) {
  return "rt" + topic;
}

std::vector<rmw_dds_common_msg_dds__Gid_> gids_of(const std::vector<Guid>& guids) {
  std::vector<rmw_dds_common_msg_dds__Gid_> gids(guids.size());
  for (std::size_t i = 0; i < guids.size(); ++i) std::ranges::copy(guids[i], gids[i].data);
  return gids;
}

}  // namespace

std::string allowed_name(const std::string& name) {
  std::string allowed = name;
  for (char& c : allowed)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return std::isdigit(static_cast<unsigned char>(allowed.front())) ? "n" + allowed : allowed;
}

Node::Node(const BusSettings& settings, std::string name)
    : name_(std::move(name)),
      participant_(settings, "enclave=/;"),
      about_(participant_, "ros_discovery_info", rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc,
             {.depth = 1, .latched = true}) {}

PlainWriter Node::publisher(const std::string& topic, const dds_topic_descriptor& type) {
  const PlainWriter writer(participant_, dds_name(topic), type);
  writers_.push_back(writer.guid());
  return writer;
}

PlainReader Node::subscription(const std::string& topic, const dds_topic_descriptor& type) {
  const PlainReader reader(participant_, dds_name(topic), type);
  readers_.push_back(reader.guid());
  return reader;
}

void Node::announce() {
  auto writers = gids_of(writers_), readers = gids_of(readers_);
  rmw_dds_common_msg_dds__NodeEntitiesInfo_ node{};
  node.node_namespace = lend("/");
  node.node_name = lend(name_);
  lend(writers, node.writer_gid_seq);
  lend(readers, node.reader_gid_seq);
  rmw_dds_common_msg_dds__ParticipantEntitiesInfo_ about{};
  std::ranges::copy(participant_.guid(), about.gid.data);
  about.node_entities_info_seq = {._maximum = 1, ._length = 1, ._buffer = &node, ._release = false};
  about_.write(&about);
}

}  // namespace palpate::ros
