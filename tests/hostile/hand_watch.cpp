#include "tests/hostile/hand_watch.hpp"

#include <algorithm>

#include "common/bus/dds_convert.hpp"
#include "idl/topics.hpp"

namespace palpate::testing {
namespace {

dds_entity_t make_reader(dds_entity_t participant, dds_entity_t topic) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, 0);
  dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, DDS_LENGTH_UNLIMITED);
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, nullptr);
  dds_delete_qos(qos);
  return reader;
}

}  // namespace

HandWatch::HandWatch(const BusSettings& settings, int tools)
    : participant_(make_participant(settings), "watching the hand"),
      topic_(dds_create_topic(participant_, &dds::Generated<ForceState>::descriptor(), topics::force_state.name,
                              nullptr, nullptr),
             "watching the hand"),
      reader_(make_reader(participant_, topic_), "watching the hand"),
      felt_(tools) {}

void HandWatch::look() {
  for (;;) {
    void* sample = nullptr;
    dds_sample_info_t info;
    if (dds_take(reader_, &sample, &info, 1, 1) <= 0) return;
    if (writer_ == 0) writer_ = info.publication_handle;
    ForceState force;
    if (info.valid_data) fields(dds::CopyOut{}, force, *static_cast<dds::Generated<ForceState>::Type*>(sample));
    if (info.valid_data && info.publication_handle == writer_) felt_.at(force.tool).add(force);
    dds_return_loan(reader_, &sample, 1);
  }
}

void HandWatch::begin_anew() {
  look();
  for (FeltForce& felt : felt_) felt.begin_anew();
  stolen_before_ = HostWatch::stolen();
}

double HandWatch::rate_hz(const HostWatch& host) const {
  const std::optional<ForceState>& first = felt_.back().first();
  if (!first || newest().sense_ns <= first->sense_ns) return 0;
  double late = 0, stood = 0;
  for (const FeltForce::Late& step : felt_.back().late()) {
    late += 1e-9 * static_cast<double>(step.lost_ns);
    stood += std::min(1e-9 * static_cast<double>(step.lost_ns), host.stood_still(step.from_ns, step.to_ns));
  }
  const double machines = std::max(stood, std::min(late, HostWatch::stolen() - stolen_before_));
  const double seconds = 1e-9 * static_cast<double>(newest().sense_ns - first->sense_ns) - machines;
  return static_cast<double>(newest().step - first->step) / seconds;
}

}  // namespace palpate::testing
