#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "common/sim/haptic_step.hpp"
#include "common/tool/device_sample.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// What one haptic step hands to the publisher: filled in place in the ring, in memory that prepare_record() took.
struct StepRecord {
  static constexpr int kMaxTools = 8;

  struct OfTool {
    ToolDofs dofs;
    double opening;
    bool holding;
    std::uint64_t device_seq;
    std::array<double, 3> force, torque, press, trocar;
    std::array<double, 4> along;  ///< [N m, N m, N, N m] force and torque along yaw, pitch, depth, roll
    double grip_torque;
    std::uint32_t flags;
    std::uint64_t model_run, model_seq;  ///< local contact model in use
  };

  template <class What>
  struct By {
    int tool;
    What what;
  };

  std::uint64_t step;
  std::int64_t sense_ns;
  std::int64_t pushed_ns;  ///< when it was put into the ring
  double energy;           ///< [J] put in by all tools
  int tools;
  std::array<OfTool, kMaxTools> of_tool;
  std::vector<By<HeldContact>> contacts;
  std::vector<By<NodalForce>> forces;

  /// What bodies tell beside their contacts; of this step where it is due, else of an earlier one.
  std::vector<BodyNews> news;
};

/// Makes room in a slot of the ring for the bodies of a scene.
void prepare_record(const HapticStep& haptic, StepRecord& record);

/// Copies a finished step into `record`. No allocation.
void fill_record(const HapticStep& haptic, std::span<const DeviceSample> samples, std::uint64_t step,
                 std::int64_t sense_ns, StepRecord& record);

}  // namespace palpate
