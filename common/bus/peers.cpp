#include "common/bus/peers.hpp"

namespace palpate {

Peers::Peers(dds_entity_t participant)
    : reader_(dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr),
              "listening for writers") {
  dds_listener_t* const listener = dds_create_listener(this);
  dds_lset_data_available(listener, &Peers::changed);
  dds_set_listener(reader_, listener);
  dds_delete_listener(listener);
  changed(reader_, this);  // those that were there before
}

std::uint64_t Peers::of(dds_instance_handle_t writer) const {
  const std::lock_guard lock(mutex_);
  const auto found = of_.find(writer);
  return found == of_.end() ? 0 : found->second;
}

bool Peers::has(std::uint64_t participant) const {
  const std::lock_guard lock(mutex_);
  return writers_.contains(participant);
}

void Peers::changed(dds_entity_t reader, void* self) {
  void* sample = nullptr;
  dds_sample_info_t info;
  while (dds_take(reader, &sample, &info, 1, 1) > 0) {
    static_cast<Peers*>(self)->note(*static_cast<const dds_builtintopic_endpoint_t*>(sample), info);
    dds_return_loan(reader, &sample, 1);
    sample = nullptr;
  }
}

void Peers::note(const dds_builtintopic_endpoint_t& writer, const dds_sample_info_t& info) {
  const std::lock_guard lock(mutex_);
  const auto known = of_.find(info.instance_handle);
  if (info.instance_state == DDS_IST_ALIVE) {
    if (known != of_.end() || !info.valid_data) return;
    of_.emplace(info.instance_handle, writer.participant_instance_handle);
    ++writers_[writer.participant_instance_handle];
  } else if (known != of_.end()) {
    if (--writers_[known->second] == 0) writers_.erase(known->second);
    of_.erase(known);
  }
}

}  // namespace palpate
