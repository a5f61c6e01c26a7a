#include "tools/node_plan.hpp"

namespace palpate {

NodePlan plan_nodes(const Scene& scene, const RunWishes& wishes) {
  NodePlan plan;
  plan.recorder = wishes.log || scene.record.has_value();
  plan.web = wishes.browsers;
  // In a browser or off screen: nobody would see a third picture.
  plan.render = (scene.render && !plan.web) || wishes.picture;
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
