#pragma once
#include <filesystem>
#include <memory>
#include <vector>

#include "common/bus/log_bus.hpp"
#include "common/sim/simulator.hpp"
#include "haptic_node/publisher.hpp"

namespace palpate::drive {

/// Writes what the nodes of a running system would publish, so that `info`, `export`, `replay` and its --verify read a
/// run in lock step as one of theirs. No time passes between a sense and its messages.
class StepLog {
 public:
  /// Throws std::runtime_error if the file cannot be written.
  StepLog(const std::filesystem::path& file, sim::Simulator& simulator);

  void before_step();  ///< once a simulated second, the state from which a replay can start
  void after_step();
  /// Throws std::runtime_error if something could not be written.
  void finish();

 private:
  void write_tissue_step();
  void write_changes();
  void write_surfaces();

  std::filesystem::path file_;
  sim::Simulator& simulator_;
  std::uint64_t keyframe_interval_, surface_interval_;  ///< steps
  LogClock clock_;
  LogWriter log_;
  std::unique_ptr<Bus> bus_;
  Publisher haptic_;
  std::unique_ptr<Writer<TopologyChange>> changes_;
  std::unique_ptr<Writer<LocalContactModel>> models_;
  std::unique_ptr<Writer<DeformStep>> steps_;
  std::unique_ptr<Writer<DeformKeyframe>> keyframes_;
  std::unique_ptr<Writer<SurfaceState>> surfaces_;
  std::vector<std::uint64_t> change_seq_;  ///< per body
  std::uint64_t keyframe_seq_ = 0, surface_seq_ = 0;
};

}  // namespace palpate::drive
