#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/bus/presence.hpp"

namespace palpate {

/// Tells the operator what the link does: which nodes have fallen silent and which are back, and, in a node that is
/// alone, where it listens.
class LinkWatch {
 public:
  static constexpr std::int64_t kSilentAfterNs = 2'500'000'000;  ///< each node announces itself once a second
  static constexpr std::int64_t kAloneAfterNs = 5'000'000'000;
  static constexpr std::int64_t kLookNs = 1'200'000'000;  ///< between two looks no more than this counts

  explicit LinkWatch(const Bus& bus) : place_(bus.place()) {}

  /// Sentences about what has changed. Call once a second or oftener, after Presence::watch(). While this node itself
  /// stood still nobody else was silent.
  std::vector<std::string> look(const Presence& presence, std::int64_t now_ns);
  /// "nothing from NODE for 4 s", of the node of this role that was there last; empty while one is heard, or none ever
  /// was.
  std::string silence(const std::string& role, std::int64_t now_ns) const;
  /// Whether two sentences of silence() are of the same node.
  static bool same_silence(std::string_view a, std::string_view b);

 private:
  struct Heard {
    std::string role;
    std::uint64_t seq = 0;
    std::int64_t last_ns = 0;
    bool silent = false;
  };
  void leave_out_pause(std::int64_t now_ns);

  std::string place_;
  std::map<std::string, Heard> heard_;  ///< by node
  std::int64_t looked_ns_ = 0;
  std::int64_t company_ns_ = 0;  ///< when another node was there, or this one began
  bool said_alone_ = false;
};

}  // namespace palpate
