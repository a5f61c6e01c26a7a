#include "common/bus/dds_wake.hpp"

#include <algorithm>
#include <utility>

namespace palpate {

DdsWake::DdsWake(dds_entity_t participant)
    : all_(dds_create_waitset(participant), "creating a wait set"),
      left_(dds_create_guardcondition(participant), "creating a guard condition"),
      only_left_(dds_create_waitset(participant), "creating a wait set"),
      listener_(dds_create_listener(this)) {
  dds_waitset_attach(only_left_, left_, 0);
  dds_lset_data_available(listener_, [](dds_entity_t, void* self) { static_cast<DdsWake*>(self)->came(); });
}

bool DdsWake::wait(std::chrono::nanoseconds timeout) {
  const dds_duration_t limit = std::max<dds_duration_t>(timeout.count(), 0);
  if (!serves_.load()) return dds_waitset_wait(all_, nullptr, 0, limit) > 0;
  bool left = false;
  if (dds_waitset_wait(only_left_, nullptr, 0, limit) > 0) dds_take_guardcondition(left_, &left);
  return left;
}

void DdsWake::serve(std::function<bool()> news) {
  const std::lock_guard lock(calling_);
  news_ = std::move(news);
  serves_.store(news_ != nullptr);
  dds_set_guardcondition(left_, serves_.load());  // what has come before
}

// The middleware has more threads than one, and what is served may be what this thread wrote itself: whoever finds a
// call under way leaves the next one to it.
void DdsWake::came() {
  if (!serves_.load() || due_.fetch_add(1) > 0) return;
  int due;
  do {
    due = due_.load();
    const std::lock_guard lock(calling_);
    if (news_ && !news_()) dds_set_guardcondition(left_, true);
  } while (due_.fetch_sub(due) != due);
}

}  // namespace palpate
