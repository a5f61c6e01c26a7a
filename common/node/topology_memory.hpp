#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/bus/bus.hpp"
#include "common/bus/presence.hpp"

namespace palpate {

/// What the bodies of a scene have lost, by the changes that the deformation node published, in a node that does not
/// own them. One that comes late receives all changes so far; where one is missing it asks for all of them anew. What
/// is known goes out again as HeldTopology, so that a deformation node that died begins where it was.
class TopologyMemory {
 public:
  /// One archive per body; those without tetrahedra cannot be cut and are not followed.
  TopologyMemory(Bus& bus, const Presence& presence, const std::vector<Archive>& archives);

  /// Takes what has come and tells what is new, each body at most every 50 ms. The bodies that have changed, ascending.
  std::vector<int> take();

  const std::vector<int>& removed(int body) const { return bodies_.at(body).removed; }  ///< in order of removal
  /// Those of them that tools have cut, not torn or fallen away, since the deformation node began.
  const std::vector<int>& cut(int body) const { return bodies_.at(body).cut; }
  /// Start of the deformation node whose changes these are, 0: none. Another one's list may be any other.
  std::uint64_t run(int body) const { return bodies_.at(body).run; }
  std::uint64_t refused() const { return refused_; }  ///< messages that do not fit the archives

 private:
  struct Followed {
    std::size_t tetrahedra = 0;
    std::uint64_t run = 0, seq = 0;
    std::vector<int> removed, cut;
    HeldTopology told;
    std::int64_t told_ns = 0;
    bool news = true;  ///< not told yet
  };
  void listen();
  void take_changes(std::vector<int>& changed);
  bool apply(const TopologyChange& change, Followed& body);
  void ask_anew(std::int64_t now);
  void tell(std::int64_t now);

  Bus& bus_;
  const Presence& presence_;
  std::size_t room_;  ///< [bytes] for changes that wait
  std::unique_ptr<Reader<TopologyChange>> reader_;
  std::unique_ptr<Writer<HeldTopology>> writer_;
  std::map<int, Followed> bodies_;
  std::uint64_t run_ = 0, refused_ = 0;
  bool lacks_ = false;         ///< a change is missing
  std::int64_t asked_ns_ = 0;  ///< when all were last asked for
};

}  // namespace palpate
