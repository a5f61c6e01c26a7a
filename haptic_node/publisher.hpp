#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/sim/step_record.hpp"

namespace palpate {

/// Turns step records into messages and writes them. Runs on the publisher thread.
class Publisher {
 public:
  Publisher(Bus& bus, const HapticStep& haptic, std::uint64_t run);

  void publish(const StepRecord& record);
  void publish(const HapticKeyframe& keyframe);
  /// After the last record: how the tasks ended.
  void finish();

 private:
  void publish_contacts(const StepRecord& record, int tool);
  void publish_shapes(const StepRecord& record);
  void take_tasks(const StepRecord& record);

  /// Without contact the topic falls silent but for one sample in so many steps.
  static constexpr int kQuietInterval = 100;
  /// Steps from one task record to the next.
  static constexpr std::uint64_t kTaskInterval = 100;
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
  // Of bodies whose state the haptic node owns; null without any.
  std::unique_ptr<Writer<ModalState>> modal_;
  std::unique_ptr<Writer<CatheterState>> catheter_;
  std::unique_ptr<Writer<TaskRecord>> task_;
  std::vector<ModalState> modal_states_;  ///< kept between steps for their memory
  std::vector<CatheterState> catheter_states_;
  std::vector<TaskRecord> task_records_;
};

}  // namespace palpate
