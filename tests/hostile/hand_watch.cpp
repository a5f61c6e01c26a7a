#include "tests/hostile/hand_watch.hpp"

#include <algorithm>
#include <cmath>

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

double size(const ForceState& f) {
  return std::hypot(f.force[0], f.force[1], f.force[2]);
}

}  // namespace

HandWatch::HandWatch(const BusSettings& settings, std::uint32_t tool)
    : tool_(tool),
      participant_(make_participant(settings), "watching the hand"),
      topic_(dds_create_topic(participant_, &dds::Generated<ForceState>::descriptor(), topics::force_state.name,
                              nullptr, nullptr),
             "watching the hand"),
      reader_(make_reader(participant_, topic_), "watching the hand") {}

void HandWatch::look() {
  for (;;) {
    void* sample = nullptr;
    dds_sample_info_t info;
    if (dds_take(reader_, &sample, &info, 1, 1) <= 0) return;
    if (writer_ == 0) writer_ = info.publication_handle;
    ForceState force;
    if (info.valid_data) fields(dds::CopyOut{}, force, *static_cast<dds::Generated<ForceState>::Type*>(sample));
    if (info.valid_data && info.publication_handle == writer_ && force.tool == tool_) add(force);
    dds_return_loan(reader_, &sample, 1);
  }
}

void HandWatch::add(const ForceState& force) {
  for (const auto& v : {force.force, force.torque}) finite_ = finite_ && std::isfinite(v[0] + v[1] + v[2]);
  max_force_ = std::max(max_force_, size(force));
  if (first_ && force.step > newest_.step)
    max_rise_ = std::max(max_rise_, (size(force) - size(newest_)) / static_cast<double>(force.step - newest_.step));
  newest_ = force;
  if (!first_) first_ = force;
  ++steps_;
}

void HandWatch::begin_anew() {
  look();
  first_.reset();
  steps_ = 0;
  max_force_ = max_rise_ = 0;
}

double HandWatch::rate_hz(const HostWatch& host) const {
  if (!first_ || newest_.sense_ns <= first_->sense_ns) return 0;
  return host.rate_hz(static_cast<double>(newest_.step - first_->step), first_->sense_ns, newest_.sense_ns);
}

}  // namespace palpate::testing
