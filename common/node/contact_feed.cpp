#include "common/node/contact_feed.hpp"

#include <spdlog/spdlog.h>

namespace palpate {

ContactFeed::ContactFeed(Bus& bus, const Presence& presence, Deformer& deformer)
    : presence_(presence),
      deformer_(deformer),
      contacts_(bus.reader(topics::contact_state)),
      held_(bus.writer(topics::held_contacts)) {
  if (deformer.has_modal_shells()) modes_ = bus.reader(topics::modal_state);
  if (deformer.has_catheters()) catheters_ = bus.reader(topics::catheter_state);
}

template <class M>
void ContactFeed::take_all(Reader<M>& reader) {
  while (const auto message = reader.take()) refused_ += !(presence_.accepts(message->run) && deformer_.take(*message));
}

bool ContactFeed::take() {
  take_all(*contacts_);
  if (modes_) take_all(*modes_);
  if (catheters_) take_all(*catheters_);
  return deformer_.fresh();
}

void ContactFeed::watch_haptic() {
  const bool alive = contacts_->writers() > 0;
  if (haptic_alive_ && !alive) {
    int kept = 0;
    for (const auto& [tool, contacts] : deformer_.contacts())
      if (!contacts.contacts.empty()) kept += held_->write(contacts);
    spdlog::warn("the haptic node is gone; keeping the contacts of {} tools for its return", kept);
  }
  haptic_alive_ = alive;
}

}  // namespace palpate
