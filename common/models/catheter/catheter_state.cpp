#include <algorithm>
#include <cstring>

#include "common/models/catheter/catheter_body.hpp"

namespace palpate {

/// Calls visit(pointer, bytes) for every piece of state, always in the same order.
template <class Self, class Visit>
void CatheterBody::visit_state(Self& self, Visit&& visit) {
  const auto all = [&](auto&& values) { visit(values.data(), values.size() * sizeof(values[0])); };
  all(self.x_);
  all(self.v_);
  all(self.tension_);
  all(self.lumen_.inside());
  all(self.lumen_.seen());
  visit(&self.lumen_.turn(), sizeof(int));
  for (auto& grasp : self.grasps_.all()) {
    visit(&grasp.count, sizeof grasp.count);
    visit(&grasp.stiffness, sizeof grasp.stiffness);
    for (auto& held : grasp.held) {
      visit(&held.point.segment, sizeof held.point.segment);
      visit(&held.point.along, sizeof held.point.along);
      visit(held.in_jaw.data(), 3 * sizeof(double));
      visit(held.target.data(), 3 * sizeof(double));
    }
  }
  all(self.wall_touches_.past());
  all(self.tool_touches_.pairs());
  all(self.solve_.memory());
}

std::size_t CatheterBody::state_size() const {
  std::size_t size = 0;
  visit_state(*this, [&](const void*, std::size_t bytes) { size += bytes; });
  return size;
}

void CatheterBody::save(unsigned char* to) const {
  visit_state(*this, [&](const void* from, std::size_t bytes) {
    if (bytes > 0) std::memcpy(to, from, bytes);
    to += bytes;
  });
}

void CatheterBody::restore(const unsigned char* from) {
  visit_state(*this, [&](void* to, std::size_t bytes) {
    if (bytes > 0) std::memcpy(to, from, bytes);
    from += bytes;
  });
  lumen_.refresh();
  for (auto& grasp : grasps_.all()) {
    grasp.count = std::clamp(grasp.count, 0, Grasps::kMostPoints);
    for (auto& held : grasp.held) held.point.segment = std::clamp(held.point.segment, 0, size() - 2);
  }
}

}  // namespace palpate
