#pragma once
#include <atomic>
#include <csignal>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/bus/domain.hpp"
#include "tests/hostile/attacker.hpp"
#include "tests/hostile/hand_watch.hpp"
#include "tests/loopback/loopback_scene.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate::testing {

/// The tools of the scene, by their places there.
inline constexpr double kPressed = 0.2;  ///< [m] depth of those that press
inline constexpr int kDriven = 0, kPressing = 1, kHovering = 2;

/// Two blocks side by side, one of moving tissue and one quasi-static. A scripted tool presses the moving one and
/// another hovers a few millimetres above it, near enough for the deform node to tell of it; a driver elsewhere presses
/// a third into the quasi-static one.
class HostileScene : public LoopbackScene {
 public:
  /// With keys: among them those of an insider, who may write and read all, more than any role.
  explicit HostileScene(bool with_keys);
  BusSettings insider(int domain) const;
  double waits() const;  ///< [s] in which the script does not lead its tool down

 private:
  bool with_keys_;
};

/// All nodes of that scene as processes, with the driver of the first tool in this one.
class AttackedSystem {
 public:
  AttackedSystem(int domain, bool with_keys);
  ~AttackedSystem();

  Attacker& attacker() { return attacker_; }
  HandWatch& hand() { return hand_; }
  bool in_free_air() const;  ///< the script has not begun to lead its tool down
  /// Returns once the tools that press have come down and rest: true the first time. Until then all are in free air.
  bool press();
  /// The driver elsewhere lifts its tool and comes down again as it did at first: what it has cost is paid.
  void press_again();
  /// Waits until each force is what it was before the first attack.
  bool is_undisturbed(std::chrono::milliseconds limit);
  const std::map<std::string, ChildProcess>& nodes() const { return nodes_; }
  bool all_run();
  std::map<std::string, double> memory_mb() const;  ///< resident, by node
  /// The same without an attack, while a recorder stands and all writers keep for it as much as they ever do.
  std::map<std::string, double> memory_at_most();
  /// The newest status of the node of a role, as it told itself.
  std::map<std::string, NodeStatus>& statuses() { return statuses_; }
  /// All that a role's node has said since begin_anew(), in its statuses and on its own terminal: where the machine is
  /// busy a status may be overtaken by the next one.
  const std::string& said(const std::string& role) { return said_[role]; }
  void begin_anew() {
    hand_.begin_anew();
    said_.clear();
  }

  /// Looks at everything until `done`; false when the time is over.
  template <class Done>
  bool watch(std::chrono::milliseconds limit, Done&& done) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (std::chrono::steady_clock::now() < end) {
      attacker_.bus().wait(std::chrono::milliseconds(5));
      look();
      if (done()) return true;
    }
    return false;
  }
  void watch(std::chrono::milliseconds limit) {
    watch(limit, [] { return false; });
  }
  void pause(const std::string& node) { kill(nodes_.at(node).pid(), SIGSTOP); }
  void go_on(const std::string& node) { kill(nodes_.at(node).pid(), SIGCONT); }
  /// Pictures of newer steps of the real haptic run come, and newer surfaces. `meanwhile` is called all the time.
  bool pictures_go_on(std::chrono::milliseconds limit, const std::function<void()>& meanwhile = {});
  /// Ends the nodes and returns what each says at its end.
  std::map<std::string, nlohmann::json> end();

  std::uint64_t run_of(const std::string& role) { return statuses_[role].run; }

 private:
  void start(const std::string& node);
  void look();
  void drive();

  HostileScene scene_;
  std::string domain_;
  Attacker attacker_;
  HandWatch hand_;
  std::unique_ptr<Reader<NodeStatus>> status_;
  std::unique_ptr<Reader<PictureState>> picture_;
  std::map<std::string, NodeStatus> statuses_;  ///< by role, of the processes started here
  std::map<std::string, std::ifstream> terminals_;
  std::map<std::string, std::string> said_;
  PictureState newest_picture_;
  std::uint64_t pictures_ = 0;
  std::atomic<bool> presses_ = false, over_ = false;  ///< for the driver
  std::atomic<double> driven_depth_ = 0;              ///< [m] where it is
  std::thread driver_;
  std::map<std::string, ChildProcess> nodes_;
};

}  // namespace palpate::testing
