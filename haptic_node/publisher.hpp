#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "common/bus/bus.hpp"
#include "haptic_node/step_record.hpp"

namespace palpate {

/// Turns step records into messages and writes them. Runs on the publisher thread.
class Publisher {
 public:
  Publisher(Bus& bus, int tools, std::uint64_t run);

  void publish(const StepRecord& record);
  void publish(const HapticKeyframe& keyframe);

 private:
  void publish_contacts(const StepRecord& record, int tool);

  /// Without contact the topic falls silent but for one sample in so many steps.
  static constexpr int quiet_interval = 100;
  struct OfTool {
    std::uint64_t tool_seq = 0, contact_seq = 0, force_seq = 0;
    bool touching = false;
    int quiet = 0;
    ContactState contacts;  ///< kept between steps for its memory
  };

  std::unique_ptr<Writer<ToolState>> tool_;
  std::unique_ptr<Writer<ContactState>> contact_;
  std::unique_ptr<Writer<ForceState>> force_;
  std::unique_ptr<Writer<HapticKeyframe>> keyframe_;
  std::uint64_t run_, keyframe_seq_ = 0;
  std::vector<OfTool> of_tool_;
};

}  // namespace palpate
