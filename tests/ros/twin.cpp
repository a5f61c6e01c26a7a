#include "tests/ros/twin.hpp"

#include <stdexcept>

namespace palpate::testing {
namespace {

const char* const kThisHostAlone =
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface address=\"127.0.0.1\" "
    "multicast=\"false\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
    "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex><Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery>"
    "</Domain></CycloneDDS>";

dds_qos_t* ros_default(bool latched) {
  dds_qos_t* qos = dds_create_qos();
  const dds_data_representation_id_t plain = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos, 1, &plain);
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, latched ? 1 : 10);
  dds_qset_durability(qos, latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  return qos;
}

std::string bytes(const dds_guid_t& guid) {
  return {reinterpret_cast<const char*>(guid.v), sizeof guid.v};
}

std::string user_data(const dds_qos_t* qos) {
  void* data = nullptr;
  std::size_t size = 0;
  if (!dds_qget_userdata(qos, &data, &size) || !data) return {};
  const std::string words(static_cast<const char*>(data), size);
  dds_free(data);
  return words;
}

RosTwin::Endpoint describe(const dds_builtintopic_endpoint_t& of) {
  RosTwin::Endpoint endpoint{of.type_name, user_data(of.qos), bytes(of.key), bytes(of.participant_key)};
  dds_reliability_kind_t reliability{};
  dds_duration_t blocking = 0;
  dds_durability_kind_t durability{};
  if (dds_qget_reliability(of.qos, &reliability, &blocking))
    endpoint.reliable = reliability == DDS_RELIABILITY_RELIABLE;
  if (dds_qget_durability(of.qos, &durability)) endpoint.is_volatile = durability == DDS_DURABILITY_VOLATILE;
  std::uint32_t count = 0;
  dds_data_representation_id_t* all = nullptr;
  if (!dds_qget_data_representation(of.qos, &count, &all) || !all) return endpoint;
  endpoint.plain_cdr = count == 1 && all[0] == DDS_DATA_REPRESENTATION_XCDR1;
  dds_free(all);
  return endpoint;
}

/// Everything that a reader of the middleware's own topics has, and gives the reader back.
template <class T>
void for_all(dds_entity_t reader, const std::function<void(const T&)>& see) {
  void* sample = nullptr;
  dds_sample_info_t info;
  while (dds_take(reader, &sample, &info, 1, 1) > 0) {
    if (info.valid_data) see(*static_cast<const T*>(sample));
    dds_return_loan(reader, &sample, 1);
    sample = nullptr;
  }
  dds_delete(reader);
}

}  // namespace

RosTwin::RosTwin(int domain)
    : domain_(dds_create_domain(static_cast<dds_domainid_t>(domain), kThisHostAlone)),
      participant_(dds_create_participant(static_cast<dds_domainid_t>(domain), nullptr, nullptr)) {
  if (domain_ < 0 || participant_ < 0) throw std::runtime_error("no participant for the twin of ROS");
}

RosTwin::~RosTwin() {
  dds_delete(participant_);
  dds_delete(domain_);
}

void RosTwin::subscribe(const std::string& topic, const dds_topic_descriptor_t& type,
                        std::function<void(const void*)> receive, bool latched) {
  dds_qos_t* qos = ros_default(latched);
  const dds_entity_t on = dds_create_topic(participant_, &type, topic.c_str(), nullptr, nullptr);
  readers_[dds_create_reader(participant_, on, qos, nullptr)] = std::move(receive);
  dds_delete_qos(qos);
}

dds_entity_t RosTwin::publisher(const std::string& topic, const dds_topic_descriptor_t& type) {
  dds_qos_t* qos = ros_default(false);
  const dds_entity_t on = dds_create_topic(participant_, &type, topic.c_str(), nullptr, nullptr);
  const dds_entity_t writer = dds_create_writer(participant_, on, qos, nullptr);
  dds_delete_qos(qos);
  return writer;
}

void RosTwin::take() {
  for (const auto& [reader, receive] : readers_) {
    void* sample = nullptr;
    dds_sample_info_t info;
    while (dds_take(reader, &sample, &info, 1, 1) > 0) {
      if (info.valid_data) receive(sample);
      dds_return_loan(reader, &sample, 1);
      sample = nullptr;
    }
  }
}

std::map<std::string, RosTwin::Endpoint> RosTwin::writers() {
  std::map<std::string, Endpoint> all;
  for_all<dds_builtintopic_endpoint_t>(
      dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr),
      [&](const dds_builtintopic_endpoint_t& writer) { all[writer.topic_name] = describe(writer); });
  return all;
}

std::string RosTwin::words_of(const std::string& participant) {
  std::string words;
  for_all<dds_builtintopic_participant_t>(
      dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr),
      [&](const dds_builtintopic_participant_t& other) {
        if (bytes(other.key) == participant) words = user_data(other.qos);
      });
  return words;
}

}  // namespace palpate::testing
