#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/bus/presence.hpp"
#include "common/sim/deformer.hpp"

namespace palpate {

/// Brings contacts and reduced states from the bus to a deformer: those of haptic nodes with the same scene, and no
/// others; of what bodies tell beside their contacts, only what some body of the scene follows. When the haptic node
/// dies in contact, it keeps the last contacts on the bus for the one that returns.
class ContactFeed {
 public:
  ContactFeed(Bus& bus, const Presence& presence, Deformer& deformer);

  /// Takes what has come; true if the surfaces have something new to show.
  bool take();
  /// Looks whether the haptic node has died; call a few times a second, after take(). Its contacts are handed on at
  /// once as it falls silent, whoever else writes some. That it is gone is said only once it has not told how it is for
  /// so long that it cannot have stood still for a moment.
  void watch_haptic(std::int64_t now_ns);
  std::uint64_t refused() const { return refused_; }  ///< messages of other scenes, or that do not fit this one

 private:
  template <class M>
  void take_all(Reader<M>& reader);
  void hand_on_contacts();

  const Presence& presence_;
  Deformer& deformer_;
  std::unique_ptr<Reader<ContactState>> contacts_;
  std::vector<std::function<void()>> take_news_;  ///< one a type of BodyMessage that some body follows
  std::unique_ptr<Writer<ContactState>> held_;
  bool heard_ = false;                    ///< the accepted run, since it was last looked for
  std::optional<std::int64_t> heard_ns_;  ///< when it was found heard last
  bool haptic_alive_ = false, said_gone_ = false;
  int kept_ = 0;  ///< tools whose contacts were handed on
  std::uint64_t refused_ = 0;
};

}  // namespace palpate
