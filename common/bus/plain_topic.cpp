#include "common/bus/plain_topic.hpp"

#include <dds/dds.h>
#include <fmt/format.h>

#include <algorithm>

#include "common/bus/dds_domain.hpp"
#include "common/bus/dds_entity.hpp"

namespace palpate {
namespace {

using QosPtr = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

/// An entity that its participant deletes.
dds_entity_t made(dds_entity_t entity, const std::string& what) {
  if (entity < 0) Entity failed(entity, what);  // throws
  return entity;
}

QosPtr dds_qos(const PlainQos& qos) {
  QosPtr q(dds_create_qos(), &dds_delete_qos);
  const dds_data_representation_id_t plain = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(q.get(), 1, &plain);
  dds_qset_reliability(q.get(), DDS_RELIABILITY_RELIABLE, 0);
  dds_qset_history(q.get(), DDS_HISTORY_KEEP_LAST, qos.depth);
  dds_qset_writer_data_lifecycle(q.get(), false);
  if (!qos.latched) return q;
  dds_qset_durability(q.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_durability_service(q.get(), 0, DDS_HISTORY_KEEP_LAST, qos.depth, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED);
  return q;
}

dds_entity_t make_topic(dds_entity_t participant, const std::string& name, const dds_topic_descriptor& type) {
  return made(dds_create_topic(participant, &type, name.c_str(), nullptr, nullptr),
              fmt::format("creating topic {}", name));
}

Guid guid_of(dds_entity_t entity) {
  dds_guid_t guid{};
  dds_get_guid(entity, &guid);
  return std::to_array(guid.v);
}

}  // namespace

PlainParticipant::PlainParticipant(const BusSettings& settings, const std::string& words)
    : domain_(join_domain(settings)) {
  const QosPtr qos(dds_create_qos(), &dds_delete_qos);
  dds_qset_userdata(qos.get(), words.data(), words.size());
  const std::string what = fmt::format("joining domain {}", settings.domain);
  participant_ = made(dds_create_participant(static_cast<dds_domainid_t>(settings.domain), qos.get(), nullptr), what);
  waitset_ = made(dds_create_waitset(participant_), "creating a wait set");
}

PlainParticipant::~PlainParticipant() {
  dds_delete(participant_);
}

Guid PlainParticipant::guid() const {
  return guid_of(participant_);
}

bool PlainParticipant::wait(std::chrono::nanoseconds timeout) {
  return dds_waitset_wait(waitset_, nullptr, 0, std::max<dds_duration_t>(timeout.count(), 0)) > 0;
}

PlainWriter::PlainWriter(PlainParticipant& participant, const std::string& topic, const dds_topic_descriptor& type,
                         const PlainQos& qos)
    : writer_(made(dds_create_writer(participant.participant_, make_topic(participant.participant_, topic, type),
                                     dds_qos(qos).get(), nullptr),
                   fmt::format("creating the writer of {}", topic))) {}

bool PlainWriter::write(const void* sample) {
  return dds_write(writer_, sample) == DDS_RETCODE_OK;
}

int PlainWriter::readers() const {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(writer_, &status);
  return static_cast<int>(status.current_count);
}

Guid PlainWriter::guid() const {
  return guid_of(writer_);
}

PlainReader::PlainReader(PlainParticipant& participant, const std::string& topic, const dds_topic_descriptor& type,
                         const PlainQos& qos)
    : reader_(made(dds_create_reader(participant.participant_, make_topic(participant.participant_, topic, type),
                                     dds_qos(qos).get(), nullptr),
                   fmt::format("creating the reader of {}", topic))) {
  dds_waitset_attach(participant.waitset_,
                     made(dds_create_readcondition(reader_, DDS_ANY_STATE), "creating a read condition"), 0);
}

bool PlainReader::take(const std::function<void(const void*)>& receive) {
  return take_message(
      reader_, [&](const void* sample, dds_instance_handle_t) { receive(sample); }, [](const void*) {});
}

Guid PlainReader::guid() const {
  return guid_of(reader_);
}

}  // namespace palpate
