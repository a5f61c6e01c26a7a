#include <algorithm>

#include "common/sim/forceps_hand.hpp"
#include "common/sim/tool_end.hpp"
#include "common/tool/instrument.hpp"

namespace palpate {
namespace {

/// Segments of the shaft and of two jaws that turn until they touch.
class ForcepsEnd : public ToolEnd {
 public:
  explicit ForcepsEnd(const EndPlace& place)
      : ToolEnd(tool_parts(place.tool)), hand_(place.index, place.tool, place.dt) {}

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

std::unique_ptr<ToolEnd> make_tool_end(const ForcepsSpec&, const EndPlace& place) {
  return std::make_unique<ForcepsEnd>(place);
}

}  // namespace palpate
