#include "common/models/moving/dynamic_organ.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "common/mesh/near_origin.hpp"
#include "common/mesh/normals.hpp"
#include "common/models/moving/tissue_steps.hpp"
#include "common/models/moving_kind.hpp"
#include "common/tool/instrument.hpp"
#include "common/tool/jaws.hpp"

namespace palpate {
namespace {

constexpr double kCalmed = 0.6;  // [s] for which tissue is calmed into which a tool was put: it is led out

std::span<const int> joined_nodes(const CondensedTouch* still) {
  return still ? still->part().connection() : std::span<const int>{};
}

}  // namespace

DynamicOrgan::DynamicOrgan(const Archive& archive, const MovingSpec& body, const StepSettings& settings,
                           const MakeModel& make)
    : mesh_(elastic_mesh(archive, body.dynamic.element)),
      model_(make(mesh_)),
      still_(archive.condensed ? std::make_unique<CondensedTouch>(archive, settings,
                                                                  body.dynamic.precision == Precision::float32, *model_)
                               : nullptr),
      tissue_(archive, body, settings, mesh_, *model_, joined_nodes(still_.get())),
      contacts_(archive, mesh_, tissue_.topology(), tissue_.surface(), *model_, still_.get(), settings),
      passing_(tissue_.surface(), settings.tools.size()),
      origin_(near_origin(mesh_.rest)),
      position_(mesh_.rest),
      in_tick_(settings.tools.size()),
      in_step_(settings.tools.size()) {
  for (const Tool& tool : settings.tools) {
    const EndAbilities can = abilities_of(tool);
    hands_.push_back({.closing = can.closing, .turning = forceps_shape(tool), .cautery = can.cautery});
  }
  const TissueSteps steps = tissue_steps(body.name, body.dynamic, model_->frequency_bound());
  max_step_ = steps.free;
  touched_step_ = steps.touched;
}

DynamicOrgan::~DynamicOrgan() = default;

int DynamicOrgan::steps_in(double dt, bool touched) const {
  return palpate::steps_in(dt, touched ? touched_step_ : max_step_);
}

// Of a tool that is absent nothing is left, neither parts nor what it touched; nor of what one touched where it was
// before it began anew.
void DynamicOrgan::take_tools(std::span<const ToolInTick> tools) {
  for (int t = 0; t < static_cast<int>(tools.size()); ++t) {
    in_tick_[t] = tools[t].moving;
    if (tools[t].present && !tools[t].begins) continue;
    if (!tools[t].present) in_tick_[t].parts = in_tick_[t].parts_before = {};
    hands_[t].holding = false;
    hands_[t].began = tools[t].present;
    contacts_.drop_tool(t);
    if (still_) still_->drop_tool(t);
  }
}

void DynamicOrgan::meet(std::span<const ToolInTick> tools) {
  passing_.meet(tools, !removed().empty(), [&](int t) { return ToolDeed{holds(t), glows(t, tools[t])}; });
}

void DynamicOrgan::let_pass(std::span<const ToolInTick> tools) {
  meet(tools);
  passing_.clear(tools, [&](int t) { return ToolDeed{holds(t), glows(t, tools[t])}; });
  for (int t = 0; t < static_cast<int>(tools.size()); ++t)
    if (passes(t)) in_tick_[t].parts = in_tick_[t].parts_before = {};
}

bool DynamicOrgan::glows(int tool, const ToolInTick& with) const {
  return hands_[tool].cautery && with.dofs.pedal >= 0.5;
}

// By one step, to a share of their way in the tick.
void DynamicOrgan::move_tools(double share) {
  for (std::size_t t = 0; t < in_tick_.size(); ++t) {
    const Eigen::Isometry3d &a = in_tick_[t].before, &b = in_tick_[t].now;
    in_step_[t].before = in_step_[t].now;
    in_step_[t].now.translation() = (1 - share) * a.translation() + share * b.translation();
    in_step_[t].now.linear() =
        Eigen::Quaterniond(a.linear()).slerp(share, Eigen::Quaterniond(b.linear())).toRotationMatrix();
  }
}

void DynamicOrgan::tick(std::span<const ToolInTick> tools, double dt) {
  const bool swings = std::exchange(touched_before_, touched_before_ || !contacts().empty());
  advance(tools, dt);
  if (put_into(swings)) calm_left_ = kCalmed;
  // What jaws carry goes with them: stopped, it would be a blow to the hand.
  if (calm_left_ > 0 && std::ranges::none_of(hands_, &Hand::holding)) calm();
  calm_left_ = std::max(calm_left_ - dt, 0.0);
  cut(tools);
  tear_and_drop();
}

// A tool that no motion has led here presses, once it has come in: what it pressed before swings, and so does what it
// comes into.
bool DynamicOrgan::put_into(bool swings) {
  bool any = false;
  for (int t = 0; t < static_cast<int>(hands_.size()); ++t) {
    if (!hands_[t].began) continue;
    const auto by_it = [t](const TouchContact& c) { return c.is_by(t); };
    const bool presses =
        std::ranges::any_of(contacts(), by_it) || (still_ && std::ranges::any_of(still_->contacts(), by_it));
    hands_[t].began = !presses && contacts_.lies_on(t);
    any |= presses && (swings || contacts_.leads_in(t));
  }
  return any;
}

void DynamicOrgan::settle(std::span<const ToolInTick> tools, double dt) {
  advance(tools, dt);
  tear_and_drop();
  calm();
}

void DynamicOrgan::advance(std::span<const ToolInTick> tools, double dt) {
  take_tools(tools);
  work_jaws(tools);
  let_pass(tools);
  if (still_) still_->find(in_tick_);
  for (const auto& [node, force] : contacts_.find(in_tick_, dt / steps_in(dt, true))) tissue_.fade(node, force);
  tissue_.begin_tick();
  const bool touched = contacts_.touched();
  const int steps = steps_in(dt, touched);
  in_step_ = in_tick_;
  for (MovingTool& tool : in_step_) tool.now = tool.before;
  for (int s = 1; s <= steps; ++s) {
    move_tools(static_cast<double>(s) / steps);
    if (still_) still_->hold(in_step_);
    tissue_.begin_step(contacts_.held(in_step_), dt / steps);
    if (touched)
      contacts_.step(in_step_, dt / steps);
    else
      model_->step(dt / steps);
    if (still_) still_->take();
  }
  contacts_.end_tick(in_tick_, dt);
  if (still_) still_->end_tick(in_tick_);
  update_positions();
}

bool DynamicOrgan::begin_without(std::span<const std::uint32_t> removed) {
  if (!tissue_.has(removed)) return false;
  if (tissue_.begin_without(removed)) let_go_of_gone();
  return true;
}

void DynamicOrgan::calm() {
  double energy = 0;
  for (int n = 0; n < mesh_.nodes(); ++n) energy += 0.5 * model_->mass(n) * model_->velocity(n).squaredNorm();
  const bool slower = energy < moved_with_;
  moved_with_ = slower ? 0 : energy;
  for (int n = 0; slower && n < mesh_.nodes(); ++n)
    model_->set_motion(n, model_->displacement(n), Eigen::Vector3d::Zero());
}

void DynamicOrgan::update_positions() {
  for (int n = 0; n < mesh_.nodes(); ++n) position_[n] = mesh_.rest[n] + model_->displacement(n);
  tissue_.surface().set_positions(position_);
}

// Jaws that shut hold what is between them, until they open.
void DynamicOrgan::work_jaws(std::span<const ToolInTick> tools) {
  for (int t = 0; t < static_cast<int>(tools.size()); ++t) {
    if (!tools[t].present || tools[t].holding == hands_[t].holding) continue;
    hands_[t].holding = tools[t].holding;
    if (tools[t].holding) {
      grasp(t, tools[t]);
    } else {
      contacts_.search().let_go(t);
      if (still_) still_->let_go(t);
    }
  }
}

// The quasi-static part is taken where there is no moving tissue between the jaws.
void DynamicOrgan::grasp(int tool, const ToolInTick& with) {
  const auto take = [&](auto&& from, auto&& allowed) {
    const Eigen::Isometry3d& pose = with.moving.before;
    if (const auto& jaws = hands_[tool].closing) return from.grasp(tool, pose, jaws->length, jaws->width, allowed);
    if (const auto& shape = hands_[tool].turning)
      return from.grasp(OpenJaws{tool, *shape, pose, with.opening, 0}, allowed);
    return false;
  };
  if (take(contacts_.search(), [&](int node) { return topology().has_node(node); }) || !still_) return;
  take(still_->search(), [&](int node) { return still_->part().owns(node); });
}

Eigen::Vector3d DynamicOrgan::position(int node) const {
  if (still_ && still_->part().owns(node)) return mesh_.rest[node] + still_->part().displacement(node);
  return surface().positions()[node];
}

Eigen::Vector3d DynamicOrgan::displacement(int node) const {
  return still_ && still_->part().owns(node) ? still_->part().displacement(node) : model_->displacement(node);
}

bool DynamicOrgan::holds(int tool) const {
  return contacts_.grasping(tool);
}

void DynamicOrgan::cut(std::span<const ToolInTick> tools) {
  glows_.clear();
  for (int t = 0; t < static_cast<int>(tools.size()); ++t)
    if (tools[t].present && glows(t, tools[t]))
      glows_.push_back({in_tick_[t].now.translation(), hands_[t].cautery->radius});
  if (tissue_.cut(glows_)) let_go_of_gone();
}

void DynamicOrgan::tear_and_drop() {
  if (tissue_.tear(position_)) let_go_of_gone();
  if (tissue_.drop_fallen(position_)) let_go_of_gone();
}

void DynamicOrgan::let_go_of_gone() {
  for (const auto& [node, force] : contacts_.follow_cut(topology())) tissue_.fade(node, force);
}

void DynamicOrgan::shape(std::vector<Eigen::Vector3f>& position, std::vector<Eigen::Vector3f>& normal) {
  position.resize(position_.size());
  normal.resize(position_.size());
  for (std::size_t n = 0; n < position_.size(); ++n) position[n] = (position_[n] - origin_).cast<float>();
  if (still_) still_->shape(mesh_.rest, origin_, position);
  vertex_normals(position, tissue_.shown(), normal);
}

void DynamicOrgan::state(State& s, std::span<const MovingTool> tools) {
  tissue_.state(s);
  s.same(model_->state_size());
  model_->state(s);
  s.same(hands_.size());
  for (Hand& hand : hands_) {
    s.value(hand.holding);
    s.value(hand.began);
  }
  passing_.state(s);
  s.value(calm_left_);
  s.value(moved_with_);
  s.value(touched_before_);
  tissue_.surface().state(s);
  if (s.restoring()) {
    std::ranges::copy(surface().positions(), position_.begin());
    contacts_.follow_cut(topology());
  }
  contacts_.state(s, tools);
  if (still_) still_->state(s, tools);
}

Eigen::Vector3d moving_gravity(const MovingSpec& body) {
  return body.dynamic.gravity;
}

std::unique_ptr<DynamicOrgan> make_organ(const NamedSpec&, const Archive&, const StepSettings&) {
  return nullptr;
}

std::unique_ptr<DynamicOrgan> make_moving_organ(const MovingSpec& body, const Archive& archive,
                                                const StepSettings& settings, const MakeModel& make) {
  return std::make_unique<DynamicOrgan>(archive, body, settings, make);
}

std::unique_ptr<DynamicModel> make_model(const MovingSpec& body, const ElasticMesh& mesh) {
  return make_element_model(mesh, body.dynamic);
}

}  // namespace palpate
