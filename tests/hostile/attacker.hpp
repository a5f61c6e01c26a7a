#pragma once
#include <dds/dds.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <tuple>

#include "common/bus/dds_bus.hpp"
#include "common/bus/dds_convert.hpp"
#include "common/bus/dds_entity.hpp"
#include "idl/topics.hpp"

namespace palpate::testing {

/// The readers in a domain, as discovery tells of them.
class ReadersHeard {
 public:
  explicit ReadersHeard(dds_entity_t participant)
      : reader_(dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, nullptr, nullptr), "readers") {}

  std::size_t of(std::string_view topic) const {
    constexpr int most = 1024;
    std::array<void*, most> samples{};
    std::array<dds_sample_info_t, most> infos;
    const int count = dds_read_mask(reader_, samples.data(), infos.data(), most, most, DDS_ALIVE_INSTANCE_STATE);
    if (count <= 0) return 0;
    const auto is_of_topic = [&](void* sample) {
      return static_cast<const dds_builtintopic_endpoint_t*>(sample)->topic_name == topic;
    };
    const auto found = std::count_if(samples.begin(), samples.begin() + count, is_of_topic);
    dds_return_loan(reader_, samples.data(), count);
    return static_cast<std::size_t>(found);
  }

 private:
  Entity reader_;
};

/// A writer of a topic that sends whatever it is told to: the project's own refuse what is not valid.
template <class M>
class HostileWriter {
 public:
  HostileWriter(dds_entity_t participant, const Topic<M>& topic)
      : name_(topic.name),
        topic_(dds_create_topic(participant, &dds::Generated<M>::descriptor(), topic.name, nullptr, nullptr),
               topic.name),
        writer_(dds_create_writer(participant, topic_, qos(topic.qos).get(), nullptr), topic.name) {}

  /// All readers of the topic in the domain have been found: with keys a busy machine takes seconds.
  bool reaches_all(const ReadersHeard& readers) const {
    dds_publication_matched_status_t found{};
    return dds_get_publication_matched_status(writer_, &found) == DDS_RETCODE_OK &&
           found.current_count >= readers.of(name_);
  }
  /// False where the middleware itself does not send such a sample.
  bool write(const M& message) const { return send(message, dds_write); }
  /// Says that the message's instance is over: for all, or for this writer.
  bool dispose(const M& message) const { return send(message, dds_dispose); }
  bool unregister(const M& message) const { return send(message, dds_unregister_instance); }

 private:
  bool send(const M& message, dds_return_t (*how)(dds_entity_t, const void*)) const {
    typename dds::Generated<M>::Type sample{};
    fields(dds::Lend{}, message, sample);
    return how(writer_, &sample) == DDS_RETCODE_OK;
  }
  struct Delete {
    void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
  };
  static std::unique_ptr<dds_qos_t, Delete> qos(const Qos& of) {
    std::unique_ptr<dds_qos_t, Delete> q(dds_create_qos());
    dds_qset_reliability(q.get(), DDS_RELIABILITY_RELIABLE, 0);
    dds_qset_durability(q.get(), of.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    dds_qset_history(q.get(), DDS_HISTORY_KEEP_LAST, 1);
    dds_qset_writer_data_lifecycle(q.get(), false);
    return q;
  }
  std::string name_;
  Entity topic_, writer_;
};

/// A participant with the project's messages that writes and reads all topics of a domain, and plays by no rule.
class Attacker {
 public:
  explicit Attacker(const BusSettings& settings)
      : bus_(make_dds_bus(settings)), participant_(make_participant(settings), "attacker"), readers_(participant_) {}

  Bus& bus() { return *bus_; }
  template <class M>
  HostileWriter<M> writer(const Topic<M>& topic) const {
    return {participant_, topic};
  }
  template <class M>
  bool reaches_all(const HostileWriter<M>& writer) const {
    return writer.reaches_all(readers_);
  }

 private:
  std::unique_ptr<Bus> bus_;
  Entity participant_;
  ReadersHeard readers_;
};

}  // namespace palpate::testing
