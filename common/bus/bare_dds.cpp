#include "common/bus/bare_dds.hpp"

#include <dds/dds.h>

#include <stdexcept>

#include "common/bus/dds_domain.hpp"
#include "common/bus/dds_entity.hpp"
#include "palpate.h"

namespace palpate {

BareDds::BareDds(const BusSettings& settings, const std::string& out, const std::string& in)
    : domain_(join_domain(settings)) {
  participant_ = make_participant(settings);
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
  const auto topic = [&](const std::string& name) {
    return dds_create_topic(participant_, &palpate_HapticKeyframe_desc, name.c_str(), nullptr, nullptr);
  };
  writer_ = dds_create_writer(participant_, topic(out), qos, nullptr);
  reader_ = dds_create_reader(participant_, topic(in), qos, nullptr);
  dds_delete_qos(qos);
  waitset_ = dds_create_waitset(participant_);
  const dds_entity_t condition = dds_create_readcondition(reader_, DDS_ANY_STATE);
  if (writer_ < 0 || reader_ < 0 || waitset_ < 0 || condition < 0)
    throw std::runtime_error("network: setting up bare DDS failed");
  dds_waitset_attach(waitset_, condition, 0);
}

BareDds::~BareDds() {
  dds_delete(participant_);
}

void BareDds::send(std::uint64_t seq, std::vector<std::uint8_t>& bytes) {
  palpate_HapticKeyframe sample{};
  sample.seq = seq;
  sample.state._length = sample.state._maximum = static_cast<std::uint32_t>(bytes.size());
  sample.state._buffer = bytes.data();
  dds_write(writer_, &sample);
}

std::uint64_t BareDds::receive(std::chrono::nanoseconds timeout) {
  dds_waitset_wait(waitset_, nullptr, 0, timeout.count());
  return take();
}

void BareDds::listen(std::function<void(std::uint64_t)> receive) {
  heard_ = std::move(receive);
  dds_listener_t* listener = dds_create_listener(this);
  dds_lset_data_available(listener, [](dds_entity_t, void* self) {
    auto& port = *static_cast<BareDds*>(self);
    while (const std::uint64_t seq = port.take()) port.heard_(seq);
  });
  dds_set_listener(reader_, listener);
  dds_delete_listener(listener);
}

std::uint64_t BareDds::take() {
  void* sample = nullptr;
  dds_sample_info_t info;
  if (dds_take(reader_, &sample, &info, 1, 1) <= 0) return 0;
  const std::uint64_t seq = info.valid_data ? static_cast<palpate_HapticKeyframe*>(sample)->seq : 0;
  dds_return_loan(reader_, &sample, 1);
  return seq;
}

}  // namespace palpate
