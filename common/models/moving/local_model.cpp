#include "common/models/moving/local_model.hpp"

namespace palpate {

bool copy_model(const LocalContactModel& from, const TissueLimits& limits, LocalModel& to) {
  if (!valid(from)) return false;
  const double stiffness = limits.stiffness_of(from);
  if (stiffness < 0) return false;
  to.stiffness = stiffness;
  to.modulus = limits.modulus_of(from);
  to.run = from.run;
  to.seq = from.seq;
  to.tool_step = from.tool_step;
  to.late_ns = from.late_ns;
  to.pose = pose_values(from);
  to.contacts = static_cast<std::int32_t>(from.contacts.size());
  to.nodes = static_cast<std::int32_t>(from.nodes.size());
  to.triangles = static_cast<std::int32_t>(from.triangles.size());
  for (int i = 0; i < to.contacts; ++i) {
    const LocalContact& c = from.contacts[i];
    to.contact[i] = {c.position, c.normal, c.force, c.stiffness, c.grasped};
  }
  for (int i = 0; i < to.nodes; ++i)
    to.node[i] = {from.nodes[i].position, from.nodes[i].velocity, from.nodes[i].stiffness};
  for (int i = 0; i < to.triangles; ++i)
    to.triangle[i] = {from.triangles[i].a, from.triangles[i].b, from.triangles[i].c};
  return true;
}

}  // namespace palpate
