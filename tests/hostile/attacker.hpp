#pragma once
#include <dds/dds.h>

#include <tuple>

#include "common/bus/dds_bus.hpp"
#include "common/bus/dds_convert.hpp"
#include "common/bus/dds_entity.hpp"
#include "idl/topics.hpp"

namespace palpate::testing {

/// A writer of a topic that sends whatever it is told to: the project's own refuse what is not valid.
template <class M>
class HostileWriter {
 public:
  HostileWriter(dds_entity_t participant, const Topic<M>& topic)
      : topic_(dds_create_topic(participant, &dds::Generated<M>::descriptor(), topic.name, nullptr, nullptr),
               topic.name),
        writer_(dds_create_writer(participant, topic_, qos(topic.qos).get(), nullptr), topic.name) {}

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
  Entity topic_, writer_;
};

/// A participant with the project's messages that writes and reads all topics of a domain, and plays by no rule.
class Attacker {
 public:
  explicit Attacker(const BusSettings& settings)
      : bus_(make_dds_bus(settings)), participant_(make_participant(settings), "attacker") {}

  Bus& bus() { return *bus_; }
  template <class M>
  HostileWriter<M> writer(const Topic<M>& topic) const {
    return {participant_, topic};
  }

 private:
  std::unique_ptr<Bus> bus_;
  Entity participant_;
};

}  // namespace palpate::testing
