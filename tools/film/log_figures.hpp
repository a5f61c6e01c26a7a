#pragma once
#include <array>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/log_reader.hpp"
#include "common/dynamics/resection.hpp"
#include "common/scene/scene.hpp"
#include "common/sim/handling.hpp"
#include "common/tool/kinematics.hpp"
#include "idl/messages.hpp"
#include "tools/logs/log_time.hpp"

namespace palpate {

/// What a session comes to: how each tool was handled, what the tissue has lost, how the tasks ended.
class LogFigures {
 public:
  /// `resections`: by body, where the scene marks what is to be cut off.
  explicit LogFigures(const Scene& scene, std::map<std::uint32_t, Resection> resections = {});

  void look(const LogEvent& event);  ///< in the log's order
  void finish();                     ///< there are no more
  nlohmann::ordered_json json() const;
  bool has_forces() const;                            ///< of any tool
  std::uint64_t missing() const { return missing_; }  ///< steps of tools that the log lacks between two that it has
  /// [s] of the log when the scene's own time began: before 0 where the recorder came later.
  double scene_begin() const { return scene_begin_.value_or(0); }

  /// Where and how hard a tool was, at most every 10 ms: the largest force of that time [N], the tip's place [m].
  struct Place {
    double time = 0;
    std::size_t tool = 0;
    Eigen::Vector3d tip = Eigen::Vector3d::Zero();
    double force = 0;
  };
  const std::vector<Place>& course() const { return course_; }

 private:
  /// A step whose force the log may have later.
  struct Waiting {
    ToolState state;
    double time;
  };
  /// Steps that are flagged as of a silent device, from the first of them on.
  struct Silence {
    double begin = 0;                       ///< [s]
    std::array<std::uint64_t, 9> before{};  ///< flagged steps until then
  };
  struct OfTool {
    Trocar trocar;
    std::deque<Waiting> waiting;
    std::deque<ForceState> forces_ahead;  ///< of steps that the log has not told yet
    ForceState force;                     ///< of the last step that had one
    Handling handling;
    std::uint64_t steps = 0, forces = 0;     ///< that the log has
    std::array<std::uint64_t, 9> flagged{};  ///< steps with each bit of ForceFlag
    std::optional<Silence> silence;          ///< that lasts
    std::optional<ToolState> newest;         ///< that the log has told
    std::uint64_t run = 0;                   ///< of the last step
    double time = 0;                         ///< [s] of it
    std::size_t latest = 0;                  ///< of its places, from 1; 0: none yet
  };

  void look(const ToolState& state);
  void look(const ForceState& force);
  void look(const TopologyChange& change);
  double time_of(const ToolState& state);
  void settle(OfTool& tool, std::size_t may_wait);
  void count(OfTool& tool, const Waiting& step);
  static void count_flags(OfTool& tool, const Waiting& step);
  static void end_run(OfTool& tool);

  const Scene& scene_;
  std::vector<OfTool> tools_;
  std::map<std::uint32_t, std::array<std::uint64_t, 3>> lost_;  ///< tetrahedra of a body, by RemovalCause
  std::map<std::uint32_t, Resection> resections_;
  std::map<std::uint32_t, TaskRecord> tasks_;  ///< by catheter
  std::vector<Place> course_;
  std::uint64_t run_ = 0, missing_ = 0;
  std::optional<double> scene_begin_;
  LogTime log_time_;
  double now_ = 0, shift_ = 0;  ///< [s] of the log; from the haptic node's clock to it
};

}  // namespace palpate
