#include "tools/latency/observe.hpp"

namespace palpate::latency {

HopObserver::HopObserver(Bus& bus)
    : haptic_(bus.reader(topics::force_state, Keep::all)),
      surfaces_(bus.reader(topics::surface_state)),
      pictures_(bus.reader(topics::picture_state, Keep::all)),
      nodes_(bus.reader(topics::node_status)) {}

void HopObserver::take() {
  while (const auto m = nodes_->take()) times_.add(*m);
  while (const auto m = haptic_->take()) times_.add(*m);
  while (const auto m = surfaces_->take()) times_.add(*m);
  while (const auto m = pictures_->take()) times_.add(*m);
}

}  // namespace palpate::latency
