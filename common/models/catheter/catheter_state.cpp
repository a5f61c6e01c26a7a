#include <algorithm>

#include "common/models/catheter/catheter_body.hpp"

namespace palpate {

void CatheterBody::state(State& s) {
  s.all(x_);
  s.all(v_);
  s.all(tension_);
  s.all(lumen_.inside());
  s.all(lumen_.seen());
  s.value(lumen_.turn());
  for (auto& grasp : grasps_.all()) {
    s.value(grasp.count);
    s.value(grasp.stiffness);
    for (auto& held : grasp.held) {
      s.value(held.point.segment);
      s.value(held.point.along);
      s.value(held.in_jaw);
      s.value(held.target);
    }
  }
  s.all(wall_touches_.past());
  s.all(tool_touches_.pairs());
  s.all(solve_.memory());
  if (s.restoring()) follow_restored();
}

void CatheterBody::follow_restored() {
  lumen_.refresh();
  for (auto& grasp : grasps_.all()) {
    grasp.count = std::clamp(grasp.count, 0, Grasps::kMaxPoints);
    for (auto& held : grasp.held) held.point.segment = std::clamp(held.point.segment, 0, size() - 2);
  }
}

}  // namespace palpate
