#include "common/sim/tool_end.hpp"
#include "common/tool/instrument.hpp"
#include "common/tool/jaws.hpp"

namespace palpate {
namespace {

/// Spheres along tip and shaft; jaws, where it has some, hold what is between them once closed, until they open.
class ProbeEnd : public ToolEnd {
 public:
  ProbeEnd(const ProbeSpec& probe, const EndPlace& place)
      : ToolEnd(tool_parts(place.tool)), index_(place.index), jaws_(probe.jaws) {}

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
  std::optional<ClosingJaws> jaws_;
  std::uint8_t closed_ = 0;
};

}  // namespace

std::unique_ptr<ToolEnd> make_tool_end(const ProbeSpec& probe, const EndPlace& place) {
  return std::make_unique<ProbeEnd>(probe, place);
}

}  // namespace palpate
