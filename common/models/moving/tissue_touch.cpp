#include "common/models/moving/tissue_touch.hpp"

#include <algorithm>

namespace palpate {
namespace {

constexpr double kGivingWay = 10;  // [m/s^2] at which what has been cut away gives way, faster and faster

ToolContacts::Options tips_beside(const TissuePatches* patches) {
  ToolContacts::Options options;
  if (patches)
    options.elsewhere = [patches](int tool, int part, int facet) {
      return patches->has(tool, part) && patches->covers(facet);
    };
  return options;
}

template <class Visit>
void for_each_node(std::span<const TouchContact> contacts, Visit&& visit) {
  for (const TouchContact& c : contacts)
    for (int v = 0; v < 3; ++v)
      if (c.anchor.weights[v] != 0) visit(c.anchor.nodes[v]);
}

}  // namespace

TissueTouch::TissueTouch(const Archive& archive, const ElasticMesh& mesh, const CutMesh& topology, CutSurface& surface,
                         DynamicModel& model, HybridTouch* still, const StepSettings& settings)
    : mesh_(mesh),
      still_(still),
      model_(model),
      surface_(surface),
      free_(mesh.rest),
      response_(mesh, model),
      law_({response_, free_}, ContactLaw::Rule::barycentric, settings.contact.friction, kMaxContacts),
      patches_(
          settings.contact.rule == ContactRule::patch
              ? std::make_unique<TissuePatches>(archive, mesh, topology, surface, model, still, response_, settings)
              : nullptr),
      contacts_(surface, law_, parts_of(settings.tools), tips_beside(patches_.get())) {
  aimed_.reserve(kMaxContacts);
  all_.reserve(kMaxContacts + settings.tools.size());
}

void TissueTouch::find(std::span<const MovingTool> tools, double dt, const std::function<bool(int tool)>& holds) {
  if (dt != dt_) follow_response(dt);
  contacts_.look(tools);
  contacts_.collide(tools);
  if (patches_) patches_->find(tools, holds);
}

void TissueTouch::drop_tool(int tool) {
  for (int i = static_cast<int>(law_.contacts().size()) - 1; i >= 0; --i)
    if (law_.contacts()[i].is_by(tool)) law_.remove(i);
  if (patches_) patches_->drop_tool(tool);
  gather();
}

void TissueTouch::gather() {
  all_.assign(law_.contacts().begin(), law_.contacts().end());
  if (patches_) patches_->add_contacts(all_);
}

bool TissueTouch::grasping(int tool) const {
  return law_.grasps(tool);
}

// What pressed a triangle that has been cut away goes on pressing the nodes that are left of it, and gives way from
// then on: gone at once, its force would be a blow.
void TissueTouch::leave(TouchContact c, std::span<const MovingTool> tools, const CutMesh& topology) {
  if (c.touch == Touch::open || law_.full()) return;
  const Anchor pressed = c.anchor;
  for (int v = 0; v < 3; ++v) c.anchor.weights[v] *= topology.has_node(pressed.nodes[v]);
  if (c.anchor.weights.isZero(0))
    for (int v = 0; v < 3; ++v) c.anchor.weights[v] = topology.has_node(pressed.nodes[v]);
  if (c.anchor.weights.isZero(0)) return;
  c.anchor.weights /= c.anchor.weights.sum();
  ToolPoint& by = c.tool_point();
  const MovingTool& tool = tools[by.tool];
  const Eigen::Vector3d on_tool = nearest_point(tool.axis(by.part), c.at) + tool.radius(by.part) * c.normal;
  by.offset = tool.to_part(by.part, on_tool);
  if (c.touch == Touch::sticking) c.slip.setZero();
  c.touch = Touch::sliding;
  c.leaving = true;
  c.give.setZero();  // of a patch
  c.receded = c.normal.dot(on_tool - anchor_position(c.anchor, surface_.positions()));
  law_.add(c);
}

void TissueTouch::follow_cut(const CutMesh& topology, std::span<const MovingTool> tools) {
  const auto is_there = [&](int node) { return topology.has_node(node) || (still_ && still_->part().owns(node)); };
  const auto node_gone = [&](const TouchContact& c) {
    for (int v = 0; v < 3; ++v)
      if (c.anchor.weights[v] != 0 && !is_there(c.anchor.nodes[v])) return true;
    return false;
  };
  for (int i = static_cast<int>(law_.contacts().size()) - 1; i >= 0; --i) {
    const TouchContact c = law_.contacts()[i];
    const bool on_triangle = c.face && !c.grasped;
    if (!node_gone(c) && (!on_triangle || c.leaving || surface_.facet_of(c.anchor.nodes) >= 0)) continue;
    law_.remove(i);
    if (on_triangle) leave(c, tools, topology);
  }
  std::erase_if(all_, node_gone);
  if (patches_) patches_->follow_cut(topology, [&](const TouchContact& c) { leave(c, tools, topology); });
  follow_response(dt_);
}

void TissueTouch::follow_response(double dt) {
  dt_ = dt;
  response_.follow(dt);
  law_.follow_response();
  if (patches_) patches_->follow_response();
}

void TissueTouch::solve(std::span<const MovingTool> tools) {
  for_each_node(law_.contacts(), [&](int node) { free_[node] = mesh_.rest[node] + model_.displacement(node); });
  contacts_.aim(tools);
  aimed_.clear();
  for (TouchContact& c : law_.contacts()) {
    aimed_.push_back(c.target);
    lead_out(c, tools[c.tool_point().tool]);
  }
  law_.solve();
  for (std::size_t c = 0; c < law_.contacts().size(); ++c) law_.contacts()[c].target = aimed_[c];
}

// A tool that comes anew may stand in the tissue, and the surface that a point slides over has corners: put right
// within one step, that would be a blow.
void TissueTouch::lead_out(TouchContact& c, const MovingTool& tool) const {
  if (c.grasped) return;
  c.plane -= c.receded;
  c.target -= c.receded * c.normal;
  const Eigen::Vector3d motion = c.at - tool.before * (tool.now.inverse() * c.at);
  const Eigen::Vector3d carried = anchor_position(c.anchor, surface_.positions()) + motion;
  const double depth = c.plane - c.normal.dot(carried), led = TissuePatches::kWayOut * dt_;
  if (depth <= led) return;
  const double share = led / depth;
  c.plane -= (1 - share) * depth;
  c.target += (1 - share) * (carried - c.target);
}

void TissueTouch::put_right(double dt) {
  law_.for_each_nodal_force([&](int, int node, const Eigen::Vector3d& f) {
    const Eigen::Vector3d moved = response_.of_node(node).cwiseProduct(f);
    model_.set_motion(node, model_.displacement(node) + moved, model_.velocity(node) + moved / dt);
  });
  for_each_node(law_.contacts(), [&](int node) { surface_.place(node, mesh_.rest[node] + model_.displacement(node)); });
}

void TissueTouch::step(std::span<const MovingTool> tools, double dt) {
  model_.step_semi_implicit(dt);
  for (TouchContact& c : law_.contacts()) {
    if (!c.leaving) continue;
    c.receding += kGivingWay * dt;
    c.receded += c.receding * dt;
  }
  solve(tools);
  put_right(dt);
  for (TouchContact& c : law_.contacts()) {
    c.impulse += dt * c.force;
    c.pressed += dt * c.force.dot(c.normal) * c.normal;
  }
  contacts_.slide(tools);
  if (patches_) patches_->step(tools, dt);
}

void TissueTouch::end_tick(std::span<const MovingTool> tools, double dt) {
  all_.clear();
  for (TouchContact& c : law_.contacts()) {
    c.force = c.impulse / dt;
    TouchContact& told = all_.emplace_back(c);
    if (!c.grasped && !c.pressed.isZero(0)) told.normal = c.pressed.normalized();
    c.impulse.setZero();
    c.pressed.setZero();
  }
  contacts_.settle(tools);
  if (!patches_) return;
  patches_->end_tick(tools, dt);
  patches_->add_contacts(all_);
}

void TissueTouch::forget_factor() {
  law_.forget_factor();
  if (patches_) patches_->forget_factor();
}

void TissueTouch::state(State& s, std::span<const MovingTool> tools) {
  contacts_.state(s, tools);
  if (patches_) patches_->state(s);
  if (s.restoring()) gather();
}

}  // namespace palpate
