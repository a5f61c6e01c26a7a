#pragma once
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/shared/child_process.hpp"

namespace palpate {

inline const std::string kRecorder = "recorder";  ///< its name among the nodes

/// The nodes of one scene on this machine, in the order in which they start; the haptic node comes last.
class RunNodes {
 public:
  /// `results_alone`: what nodes say beside their results goes to standard error.
  explicit RunNodes(bool results_alone) : results_alone_(results_alone) {}

  void start(const std::string& role, const std::vector<std::string>& arguments);
  /// Reads what the nodes print: "ready", and at the end one JSON line each.
  void read();
  /// How a node has failed, in words; empty where none has.
  std::string failure();
  /// Throws if a node has failed.
  void check();
  /// Throws where one fails or is not ready within a minute; returns early at a request to stop.
  void wait_ready();
  bool last_runs() { return nodes_.back().process.running(); }
  /// Stops the nodes, the haptic node first, and gives each time to finish its files; the recorder hears all others
  /// end. Those between are told at once: one that waited for another's film would miss the haptic node meanwhile.
  void stop();
  /// What each has said at its end, by its name, with `startup_s` and `resident_bytes`.
  nlohmann::json summary() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Node {
    ChildProcess process;
    Clock::time_point begun;
    bool ready = false;
    bool hung = false;                 ///< it did not stop and was killed
    double startup = 0;                ///< [s] until it was ready
    double resident = 0;               ///< [bytes] when it was ready
    nlohmann::json summary = nullptr;  ///< its last line, once it has ended
  };

  static void await(Node& node);
  static void end(Node& node);
  static bool stopped_early(const Node& node);
  static void note_ready(Node& node);

  const bool results_alone_;
  std::vector<Node> nodes_;
};

}  // namespace palpate
