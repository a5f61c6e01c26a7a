#include "common/sim/tool_end.hpp"

#include <algorithm>

#include "common/tool/instrument.hpp"
#include "common/tool/jaws.hpp"

namespace palpate {
namespace {

/// Spheres along tip and shaft; jaws, where it has some, hold what is between them once closed, until they open.
class ProbeEnd : public ToolEnd {
 public:
  ProbeEnd(int index, const Tool& tool) : ToolEnd(tool_parts(tool)), index_(index), jaws_(tool.probe()->jaws) {}

  void work(double grip, const Eigen::Isometry3d& pose, BodyParts bodies) override {
    if (!jaws_) return;
    const bool closes = !closed_ && grip < jaws_->closed_below;
    const bool opens = closed_ && grip > jaws_->closed_below + kJawSlack;
    if (!closes && !opens) return;
    closed_ = closes;
    for (const auto& body : bodies) closes ? body->pinch(index_, pose, *jaws_) : body->let_go(index_);
  }
  bool holding() const override { return closed_ != 0; }
  const char* part_name(int part) const override { return part == 0 ? "tip" : "shaft"; }
  void state(State& s) override { s.value(closed_); }

 private:
  int index_;
  std::optional<ProbeJaws> jaws_;
  std::uint8_t closed_ = 0;
};

/// Segments of the shaft and of two jaws that turn until they touch.
class ForcepsEnd : public ToolEnd {
 public:
  ForcepsEnd(int index, const Tool& tool, double dt) : ToolEnd(tool_parts(tool)), hand_(index, tool, dt) {}

  void start(double grip) override {
    hand_.start(grip);
    turn_jaws();
    std::ranges::copy(parts_, parts_before_.begin());
  }
  void work(double grip, const Eigen::Isometry3d& pose, BodyParts bodies) override {
    std::ranges::copy(parts_, parts_before_.begin());
    hand_.work(grip, pose, bodies);
    turn_jaws();
  }
  bool holding() const override { return hand_.state().grip.holding; }
  double opening() const override { return hand_.opening(); }
  double handle() const override { return hand_.state().grip.commanded; }
  double torque() const override { return hand_.torque(); }
  const char* part_name(int part) const override { return part == forceps_shaft ? "shaft" : "jaw"; }
  void state(State& s) override {
    ForcepsHand::Memory memory = hand_.state();
    s.value(memory);
    if (!s.restoring()) return;
    hand_.set_state(memory);
    turn_jaws();
    std::ranges::copy(parts_, parts_before_.begin());
  }

 private:
  void turn_jaws() { set_opening(hand_.opening(), parts_); }

  ForcepsHand hand_;
};

}  // namespace

std::unique_ptr<ToolEnd> make_tool_end(int index, const Tool& tool, double dt) {
  if (tool.probe()) return std::make_unique<ProbeEnd>(index, tool);
  return std::make_unique<ForcepsEnd>(index, tool, dt);
}

}  // namespace palpate
