#include "common/node/contact_feed.hpp"

#include <fmt/format.h>

#include <utility>

#include "common/bus/link_watch.hpp"
#include "common/bus/topic_of.hpp"
#include "common/log/log.hpp"

namespace palpate {
namespace {

constexpr std::int64_t kSilentNs = 200'000'000;  // one that holds contacts tells of them in every step

}  // namespace

ContactFeed::ContactFeed(Bus& bus, const Presence& presence, Deformer& deformer)
    : presence_(presence),
      deformer_(deformer),
      contacts_(bus.reader(topics::contact_state)),
      held_(bus.writer(topics::held_contacts)) {
  for_each_body_message([&]<class M>(const M& message) {
    if (deformer.hears(message))
      take_news_.push_back([this, reader = std::shared_ptr(bus.reader(topic_of<M>()))] { take_all(*reader); });
  });
}

template <class M>
void ContactFeed::take_all(Reader<M>& reader) {
  while (const auto message = reader.take()) {
    const bool good = presence_.accepts(message->run) && deformer_.take(*message);
    heard_ |= good;
    refused_ += !good;
  }
}

bool ContactFeed::take() {
  take_all(*contacts_);
  for (const auto& take_news : take_news_) take_news();
  return deformer_.fresh();
}

void ContactFeed::hand_on_contacts() {
  kept_ = 0;
  for (const auto& [tool, contacts] : deformer_.contacts())
    if (!contacts.contacts.empty()) kept_ += held_->write(contacts);
}

void ContactFeed::watch_haptic(std::int64_t now_ns) {
  if (std::exchange(heard_, false)) heard_ns_ = now_ns;
  const bool alive = contacts_->writers() > 0 && heard_ns_ && now_ns - *heard_ns_ < kSilentNs;
  if (haptic_alive_ && !alive) hand_on_contacts();
  haptic_alive_ = alive;
  const Presence::Peer* haptic = presence_.holder("haptic");
  const bool gone = !alive && haptic && now_ns - haptic->heard_ns > LinkWatch::kSilentAfterNs;
  if (gone && !said_gone_)
    log_warning(kept_ > 0
                    ? fmt::format("the haptic node is gone; the contacts of {} of its tools wait for its return", kept_)
                    : "the haptic node is gone; it held nothing");
  said_gone_ = gone;
}

}  // namespace palpate
