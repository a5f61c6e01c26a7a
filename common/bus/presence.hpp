#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/bus/clock_link.hpp"

namespace palpate {

/// Announces this node and watches the others: who is there, and whether they run the same scene and archives.
class Presence {
 public:
  /// `role`: haptic, deform, render, recorder; `run`: of a haptic node, else 0.
  Presence(Bus& bus, std::string role, std::uint64_t run, std::string scene_hash, std::string archive_hash);

  const std::string& node() const { return status_.node; }
  /// Whose estimate goes out with what is announced; nullptr, as at first: none.
  void set_clock(const ClockFollower* clock) { clock_ = clock; }

  /// Publishes what has been measured; call about once a second and when `text` changes. It also says so if messages
  /// have been refused since the last time.
  void announce(double rate_hz, std::uint64_t ticks, std::uint64_t missed, double p50_us, double p99_us,
                const std::string& text = "");

  /// Takes what has come and returns a sentence for the operator for each node that is new, gone over to another
  /// run, or refused because its scene, archive or messages differ.
  std::vector<std::string> watch();

  /// True if this is the run of the haptic node whose word counts.
  bool accepts(std::uint64_t run) const;
  /// True if a node of this role is known that has the same scene and archives.
  bool matched(const std::string& role) const { return holder(role) != nullptr; }

  struct Peer {
    NodeStatus status;          ///< as it announced itself last
    std::int64_t met_ns = 0;    ///< when it was first heard of, or began another run; own clock
    std::int64_t heard_ns = 0;  ///< when it was heard of last
    bool accepted = false;      ///< it has the same scene and archives
    std::int64_t ended_ns = 0;  ///< when its writer was found gone or silent, if nothing has come since; else 0
    int told = 0;               ///< sentences about it
  };
  /// The accepted node whose word counts for this role: of those that live the one met first, since another that
  /// says it is one has come into a running system; else the one met last. nullptr if there is none. One whose writer
  /// falls silent may only stand still for a moment: for two seconds after its last word none follows it that was there
  /// beside it before, but one that comes then follows at once.
  const Peer* holder(const std::string& role) const;
  /// Of what there is one for each scene, or one in the whole domain: a driver elsewhere does not know of scenes.
  enum class Of { scene, domain };
  /// Another node that owns what this role owns: it is of the same scene and archives, or of whatever scene once this
  /// node has claimed it of the domain, is alive, and began first; nullptr if there is none.
  const NodeStatus* owner() const;
  /// Tells the others that this node owns it from now on. Throws std::runtime_error, which names the other, where there
  /// is one.
  void claim(const std::string& what, Of of = Of::scene);
  /// For three seconds after the claim: a sentence where another node claimed the same before the two heard of each
  /// other, and this is the one of them that gives way; else empty.
  std::string lost_claim() const;
  /// Those heard of within the last ten minutes, by name. Where there are more than 256, nodes of other scenes give way
  /// first, then, for one of this scene, those that are heard no more.
  const std::map<std::string, Peer>& peers() const { return peers_; }

 private:
  bool is_rival(const Peer& peer, std::int64_t now) const;
  std::string fight_with(const NodeStatus& other, const std::string& what) const;
  bool same_scene(const NodeStatus& peer) const;
  std::string meet(const NodeStatus& status) const;
  bool make_room(const NodeStatus& newcomer, std::int64_t now);
  bool may_say(std::int64_t now);
  void hear(const NodeStatus& status, std::int64_t now, std::vector<std::string>& said);

  Bus* bus_;
  std::unique_ptr<Writer<NodeStatus>> writer_;
  std::unique_ptr<Reader<NodeStatus>> reader_;
  NodeStatus status_;
  const ClockFollower* clock_ = nullptr;
  std::map<std::string, Peer> peers_;
  int said_ = 0;                ///< sentences about others
  std::int64_t saying_ns_ = 0;  ///< since when
  std::string claimed_;         ///< what this node owns
  std::int64_t claim_ns_ = 0;   ///< since when
  Of claimed_of_ = Of::scene;
  std::uint64_t told_refused_ = 0;  ///< messages that were when it was announced last
  bool said_refused_ = false;
};

}  // namespace palpate
