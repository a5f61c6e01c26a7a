#pragma once
#include <cstdint>
#include <memory>
#include <tuple>
#include <variant>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/sim/handling.hpp"
#include "common/sim/step_record.hpp"

namespace palpate {

/// A writer for each message of a variant.
template <class Variant>
struct WritersOf;
template <class... M>
struct WritersOf<std::variant<M...>> {
  using All = std::tuple<std::unique_ptr<Writer<M>>...>;
};

/// Turns step records into messages and writes them. Runs on the publisher thread.
class Publisher {
 public:
  Publisher(Bus& bus, const HapticStep& haptic, std::uint64_t run);

  void publish(const StepRecord& record);
  void publish(const HapticKeyframe& keyframe);
  /// After the last record: what is told to the end, such as how the tasks ended.
  void finish();

  /// How a tool was handled in what has been published.
  HandlingFigures handling(int tool) const { return of_tool_[tool].handling.figures(); }

 private:
  void publish_contacts(const StepRecord& record, int tool);
  void publish_news(const StepRecord& record);
  void write(BodyMessage& message);

  /// Without contact the topic falls silent but for one sample in so many steps.
  static constexpr int kQuietInterval = 100;
  struct OfTool {
    Trocar trocar;
    Handling handling;
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
  std::vector<BodyNews> news_;           ///< the newest, in the order of the records
  WritersOf<BodyMessage>::All writers_;  ///< null where no body tells such a message
};

}  // namespace palpate
