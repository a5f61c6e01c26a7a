#include "common/models/contact_feed.hpp"

#include <spdlog/spdlog.h>

namespace palpate {

ContactFeed::ContactFeed(Bus& bus, const Presence& presence, Deformer& deformer)
    : presence_(presence), deformer_(deformer), contacts_(bus.reader(topics::contact_state)), held_(bus.writer(topics::held_contacts)) {}

bool ContactFeed::take() {
  bool news = false;
  while (const auto contacts = contacts_->take()) {
    const bool good = presence_.accepts(contacts->run) && deformer_.take(*contacts);
    refused_ += !good;
    news |= good;
  }
  return news;
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
