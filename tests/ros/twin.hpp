#pragma once
#include <dds/dds.h>

#include <functional>
#include <map>
#include <string>

namespace palpate::testing {

/// A participant as rmw_cyclonedds makes one with automatic discovery on this host alone, with ROS's default quality of
/// service: the middleware's own interface and types of its own, nothing of the project.
class RosTwin {
 public:
  explicit RosTwin(int domain);
  ~RosTwin();
  RosTwin(const RosTwin&) = delete;

  /// `topic`: as on the wire, "rt/tf".
  void subscribe(const std::string& topic, const dds_topic_descriptor_t& type, std::function<void(const void*)> receive,
                 bool latched = false);
  dds_entity_t publisher(const std::string& topic, const dds_topic_descriptor_t& type);
  void take();  ///< what has come

  /// What the middleware knows of a topic's writer.
  struct Endpoint {
    std::string type, user_data;
    std::string guid, participant;  ///< 16 bytes
    bool reliable = false, is_volatile = false, plain_cdr = false;
  };
  std::map<std::string, Endpoint> writers();  ///< by topic
  /// User data of a participant.
  std::string words_of(const std::string& participant);

 private:
  dds_entity_t domain_, participant_;
  std::map<dds_entity_t, std::function<void(const void*)>> readers_;
};

}  // namespace palpate::testing
