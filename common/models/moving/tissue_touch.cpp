#include "common/models/moving/tissue_touch.hpp"

#include <algorithm>

#include "common/models/moving/fading_loads.hpp"
#include "common/models/moving/local_body.hpp"

namespace palpate {
namespace {

// What is not a patch's rests on points, under each of which the tissue gives way as under a patch of one square.
ToolContacts::Options beside_patches(const TissuePatches* patches, const std::function<bool(int tool)>& grasps) {
  ToolContacts::Options options;
  if (!patches) return options;
  options.elsewhere = [patches, grasps](int tool, int part, int facet) {
    return patches->has(tool, part) && patches->covers(facet) && !grasps(tool);
  };
  options.face_give = [patches](double radius) { return patches->give_of_point(radius); };
  return options;
}

constexpr double kPassed = 1;                           // mean edge
constexpr double kFarthest = 0.5 * LocalBody::kBeside;  // [m] beyond two radii: before the haptic node leaves it out

template <class Visit>
void for_each_node(std::span<const TouchContact> contacts, Visit&& visit) {
  for (const TouchContact& c : contacts)
    for (int v = 0; v < 3; ++v)
      if (c.anchor.weights[v] != 0) visit(c.anchor.nodes[v]);
}

}  // namespace

TissueTouch::TissueTouch(const Archive& archive, const ElasticMesh& mesh, const CutMesh& topology, CutSurface& surface,
                         DynamicModel& model, CondensedTouch* still, const StepSettings& settings)
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
      contacts_(surface, law_, parts_of(settings.tools),
                beside_patches(patches_.get(), [this](int tool) { return grasping(tool); })),
      passed_(kPassed * mean_edge(archive.surface)),
      fading_ticks_(fading_ticks(settings.dt)),
      max_leavers_((kMaxContacts + 2 * settings.tools.size()) * fading_ticks_) {  // with a tip's and a shaft's patch
  aimed_.reserve(kMaxContacts);
  all_.reserve(kMaxContacts + max_leavers_ + 2 * settings.tools.size());
  leavers_.reserve(max_leavers_);
  holds_.reserve(kMaxContacts);
  loose_.reserve(3 * kMaxContacts + 2 * settings.tools.size() * Patch::kMaxNodes);
}

std::span<const PatchForce> TissueTouch::find(std::span<const MovingTool> tools, double dt) {
  if (dt != dt_) follow_response(dt);
  loose_.clear();
  drop_where([&](const TouchContact& c) { return passed(c, tools[c.tool_point().tool]); });
  contacts_.look(tools);
  contacts_.collide(tools);
  if (patches_)
    patches_->find(
        tools, [this](int tool) { return grasping(tool); }, loose());
  return loose_;
}

// Round an edge in which the tissue ends, or through a flap: held on to, it would be drawn along.
bool TissueTouch::passed(const TouchContact& c, const MovingTool& tool) const {
  if (c.grasped) return false;
  const Eigen::Vector3d anchor = anchor_position(c.anchor, surface_.positions());
  const int part = c.tool_point().part;
  const double away = (anchor - nearest_point(tool.axis(part), anchor)).norm();
  const double radius = tool.radius(part);
  return away > radius + std::min(c.softness() * c.force.norm() + passed_, radius + kFarthest);
}

bool TissueTouch::lies_on(int tool) const {
  return (patches_ && patches_->laid(tool)) ||
         std::ranges::any_of(law_.contacts(), [tool](const TouchContact& c) { return c.is_by(tool); });
}

// What they did to nodes is loose.
template <class Gone>
void TissueTouch::drop_where(Gone&& gone) {
  for (int i = static_cast<int>(law_.contacts().size()) - 1; i >= 0; --i) {
    const TouchContact c = law_.contacts()[i];
    if (!gone(c)) continue;
    law_.remove(i);
    for (int v = 0; v < 3; ++v)
      if (c.anchor.weights[v] != 0) loose_.push_back({c.anchor.nodes[v], c.anchor.weights[v] * c.force});
    leave(c);
  }
}

void TissueTouch::drop_tool(int tool) {
  for (int i = static_cast<int>(law_.contacts().size()) - 1; i >= 0; --i)
    if (law_.contacts()[i].is_by(tool)) law_.remove(i);
  if (patches_) patches_->drop_tool(tool);
  std::erase_if(leavers_, [&](const Leaver& l) { return l.by.tool == tool; });
  gather();
}

void TissueTouch::gather() {
  all_.assign(law_.contacts().begin(), law_.contacts().end());
  for (const Leaver& l : leavers_) tell(l);
  if (patches_) patches_->add_contacts(all_);
}

bool TissueTouch::grasping(int tool) const {
  return law_.grasps(tool) || (still_ && still_->grasping(tool));
}

std::span<const JawHold> TissueTouch::held(std::span<const MovingTool> tools) {
  holds_.clear();
  for (const TouchContact& c : law_.contacts()) {
    if (!c.grasped) continue;
    const MovingTool& tool = tools[c.tool_point().tool];
    holds_.push_back({c.anchor, tool.now * tool.before.inverse()});
  }
  return holds_;
}

// Gone at once, its force would be a blow to the hand.
void TissueTouch::leave(const TouchContact& c) {
  std::erase_if(all_, [&](const TouchContact& told) {
    return told.is_by(c.tool_point().tool, c.tool_point().part) && told.touch == c.touch &&
           told.anchor.nodes == c.anchor.nodes;
  });
  if (c.force.isZero(0)) return;
  leavers_.push_back({c.tool_point(), c.anchor, c.grasped, fading_ticks_, c.normal, c.force, c.at});
  tell(leavers_.back());
}

void TissueTouch::tell(const Leaver& l) {
  TouchContact& told = all_.emplace_back();
  told.by = l.by;
  told.anchor = l.anchor;
  told.face = true;
  told.grasped = l.grasped;
  told.normal = l.normal;
  told.force = static_cast<double>(l.ticks_left) / fading_ticks_ * l.force;
  told.at = told.position = l.at;
}

void TissueTouch::fade(std::span<const MovingTool> tools) {
  std::erase_if(leavers_, [](Leaver& l) { return --l.ticks_left <= 0; });
  for (Leaver& l : leavers_) {
    const MovingTool& tool = tools[l.by.tool];
    l.at = l.grasped ? tool.now * l.by.offset : tool.to_world(l.by.part, l.by.offset);
    tell(l);
  }
}

std::span<const PatchForce> TissueTouch::follow_cut(const CutMesh& topology) {
  const auto is_there = [&](int node) { return topology.has_node(node) || (still_ && still_->part().owns(node)); };
  const auto has_gone = [&](const TouchContact& c) {
    for (int v = 0; v < 3; ++v)
      if (c.anchor.weights[v] != 0 && !is_there(c.anchor.nodes[v])) return true;
    return c.face && !c.grasped && surface_.facet_of(c.anchor.nodes) < 0;
  };
  loose_.clear();
  drop_where(has_gone);
  if (patches_) patches_->follow_cut(topology, loose());
  follow_response(dt_);
  return loose_;
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
  const Eigen::Vector3d motion = c.at - tool.before * (tool.now.inverse() * c.at);
  const Eigen::Vector3d carried = anchor_position(c.anchor, surface_.positions()) + c.softness() * c.force + motion;
  const double depth = c.plane - c.normal.dot(carried), led = Patch::kWayOut * dt_;
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
  fade(tools);
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
  leavers_state(s, tools);
  if (s.restoring()) gather();
}

void TissueTouch::leavers_state(State& s, std::span<const MovingTool> tools) {
  int count = static_cast<int>(leavers_.size());
  s.value(count);
  s.require(count >= 0 && count <= static_cast<int>(max_leavers_), "the state names an impossible number of contacts");
  leavers_.resize(count);
  for (Leaver& l : leavers_) {
    palpate::state(s, l.by);
    palpate::state(s, l.anchor);
    s.value(l.grasped);
    s.value(l.ticks_left);
    for (Eigen::Vector3d* v : {&l.normal, &l.force, &l.at}) s.value(*v);
    if (!s.restoring()) continue;
    const int known = static_cast<int>(tools.size());
    const bool tool = l.by.tool >= 0 && l.by.tool < known && l.by.part >= 0 && l.by.part < tools[l.by.tool].size();
    const bool nodes = std::ranges::all_of(l.anchor.nodes, [&](int n) { return n >= 0 && n < mesh_.nodes(); });
    const bool fades = l.ticks_left > 0 && l.ticks_left <= fading_ticks_;
    s.require(tool && nodes && fades, "the state holds a contact that this scene cannot have");
  }
}

}  // namespace palpate
