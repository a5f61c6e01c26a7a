#include "tools/node_plan.hpp"

namespace palpate {

NodePlan plan_nodes(const Scene& scene, const RunWishes& wishes) {
  NodePlan plan;
  plan.recorder = wishes.log || scene.record.has_value();
  plan.web = wishes.browsers;
  // Off screen, for who keeps the picture or asks for all processes; beside a browser's nobody would see a third.
  plan.render = wishes.picture || (wishes.processes != 0 && scene.render && !plan.web);
  plan.deform = wishes.processes == 3 || has_moving_tissue(scene) || plan.web;  // moving tissue needs its owner
  return plan;
}

std::vector<std::string> NodePlan::names() const {
  std::vector<std::string> all;
  if (recorder) all.emplace_back("recorder");
  if (deform) all.emplace_back("deform_node");
  if (render) all.emplace_back(superposes() ? "render_node --deform" : "render_node");
  if (web) all.emplace_back("web_node");
  all.emplace_back("haptic_node");
  return all;
}

}  // namespace palpate
