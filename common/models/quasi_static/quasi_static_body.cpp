#include "common/models/quasi_static/quasi_static_body.hpp"

#include <algorithm>
#include <functional>

#include "common/models/quasi_static/resolution.hpp"

namespace palpate {
namespace {

constexpr double kMaxSettling = 10, kTimesSettling = 5;  // [s], of the longest relaxation time

bool has_patches(const StepSettings& settings) {
  return settings.contact.rule == ContactRule::patch;
}

std::optional<CreepStep> creep_of(const QuasiStaticSpec& body, double dt) {
  if (!body.relaxation) return {};
  return CreepStep(*body.relaxation, dt);
}

// What the forces of one step meet.
Compliance<double> softened(const Archive& archive, const std::optional<CreepStep>& creep) {
  Compliance<double> compliance(archive, Compliance<double>::Rows::touchable);
  if (creep) compliance.scale(creep->instant());
  return compliance;
}

}  // namespace

QuasiStaticBody::QuasiStaticBody(const Archive& archive, const QuasiStaticSpec& body, const StepSettings& settings)
    : QuasiStaticBody(archive, body, settings, creep_of(body, settings.dt)) {}

QuasiStaticBody::QuasiStaticBody(const Archive& archive, const QuasiStaticSpec& body, const StepSettings& settings,
                                 const std::optional<CreepStep>& creep)
    : TouchBody(archive.surface, softened(archive, creep), settings, beside_patches()) {
  const HalfSpace material{archive.young[0] / (creep ? creep->instant() : 1.0), archive.poisson[0]};
  if (has_patches(settings))
    patch_ = std::make_unique<PatchTouch>(map(), compliance(), material, settings,
                                          edges_resolved(offline_of(body, map().size())), creep);
  by_mesh_ = !patch_ || patch_->parts() < parts_of(settings.tools);
  if (body.relaxation)
    settling_ = static_cast<int>(std::min(kMaxSettling, kTimesSettling * body.relaxation->times.back()) / settings.dt);
  if (body.nonlinear) nonlinear_ = make_nonlinear(body, archive);
  const std::size_t by_patches = patch_ ? PatchTouch::kMaxForces * parts_of(settings.tools) : 0;
  if (creep) memory_ = std::make_unique<ForceMemory>(*creep, compliance(), 3 * kMaxContacts + by_patches);
  const std::size_t forces = std::max(9 * kMaxContacts + by_patches, memory_ ? memory_->max_loads() : 0);
  sum_.emplace(compliance(), forces);
  under_.reserve(3 * kMaxContacts);
  touchable_.reserve(3 * kMaxContacts);
  past_under_.reserve(9 * kMaxContacts);
  displacement_.reserve(3 * map().size());
  of_tool_.reserve(3 * map().size());
  held_.reserve(map().size());
}

ToolContacts::Options QuasiStaticBody::beside_patches() {
  ToolContacts::Options options;
  options.elsewhere = [this](int tool, int part, int) { return patch_ && patch_->has(tool, part); };
  return options;
}

void QuasiStaticBody::update_surface(std::span<const MovingTool> tools) {
  if (!by_mesh_) return;
  const std::span<const int> marked = mark(tools);
  displacement_.assign(3 * marked.size(), 0.0);
  if (memory_)
    recall(Moment::now, marked, displacement_);
  else if (!nonlinear_)
    superpose(-1, displacement_);
  else
    correct(tools);
  move_marked(displacement_);
}

void QuasiStaticBody::correct(std::span<const MovingTool> tools) {
  for (int t = 0; t < static_cast<int>(tools.size()); ++t) {
    superpose(t, of_tool_);
    const Eigen::Vector3d press = press_of(t);
    add_corrected<double>(correction_of(t), of_tool_, press, displacement_);
  }
  superpose(-1, of_tool_);
  const std::span<const int> marked = surface().marked();
  held_.clear();
  for (int i = 0; i < static_cast<int>(marked.size()); ++i)
    if (is_held(marked[i])) held_.push_back(i);
  keep_held<double>(held_, of_tool_, displacement_);
}

bool QuasiStaticBody::is_held(int node) const {
  return std::ranges::any_of(law().contacts(), [&](const TouchContact& c) {
    const auto& n = c.anchor.nodes;
    return c.touch != Touch::open && (n[0] == node || (c.face && (n[1] == node || n[2] == node)));
  });
}

// u = sum C f over the contacts of one tool, or of all (-1), at the marked nodes.
void QuasiStaticBody::superpose(int tool, std::vector<double>& displacement) {
  sum_->clear();
  for_each_force([this, tool](int of_tool, int node, const Eigen::Vector3d& f) {
    if (tool < 0 || of_tool == tool) sum_->add(node, f);
  });
  const std::span<const int> marked = surface().marked();
  displacement.resize(3 * marked.size());
  sum_->at(marked, displacement);
}

// What all forces up to now have done to nodes [m], three entries a node.
void QuasiStaticBody::recall(Moment moment, std::span<const int> nodes, std::span<double> displacement) {
  sum_->clear();
  memory_->for_each_load(moment, [this](int node, const Eigen::Vector3d& load) { sum_->add(node, load); });
  sum_->at(nodes, displacement);
  memory_->add_faded(moment, nodes, displacement);
}

// What the past does to nodes before the next forces [m], three entries a node; zero beyond the touchable ones.
void QuasiStaticBody::recall_ahead(std::span<const int> nodes, std::span<double> displacement) {
  const auto touchable = [this](int node) { return node < map().touchable; };
  touchable_.assign(nodes.begin(), nodes.end());
  std::ranges::replace_if(touchable_, std::not_fn(touchable), 0);
  if (!nodes.empty()) recall(Moment::ahead, touchable_, displacement);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!touchable(nodes[i])) std::fill_n(displacement.begin() + 3 * i, 3, 0.0);
}

// The patches first, against what the other contacts did in the last step; then those, on the tissue as the patches and
// the past leave it.
LawOutcome QuasiStaticBody::hold(std::span<const MovingTool> tools) {
  bool settled = true;
  if (patch_) {
    PatchTouch::Beside beside{.others = [this](const VisitForce& visit) { TouchBody::for_each_force(visit); },
                              .holds = [this](int tool) { return law().grasps(tool); }};
    if (memory_) beside.past = [this](std::span<const int> nodes, std::span<double> u) { recall_ahead(nodes, u); };
    settled = patch_->touch(tools, beside);
  }
  if (patch_ || memory_) lay_ground();
  LawOutcome outcome = TouchBody::hold(tools);
  if (!settled) ++outcome.raised;
  if (memory_) remember();
  return outcome;
}

// Where the nodes that contacts hold are without their forces.
void QuasiStaticBody::lay_ground() {
  under_.clear();
  for (const TouchContact& c : law().contacts())
    for (int v = 0; v < 3; ++v)
      if (c.anchor.weights[v] != 0) under_.push_back(c.anchor.nodes[v]);
  past_under_.assign(3 * under_.size(), 0.0);
  if (memory_) recall_ahead(under_, past_under_);
  for (std::size_t i = 0; i < under_.size(); ++i) {
    Eigen::Vector3d moved = Eigen::Map<const Eigen::Vector3d>(past_under_.data() + 3 * i);
    if (patch_) moved += patch_->displacement(under_[i]);
    move_rest(under_[i], moved);
  }
}

void QuasiStaticBody::remember() {
  memory_->begin();
  for_each_force([this](int, int node, const Eigen::Vector3d& force) { memory_->add(node, force); });
  memory_->end();
}

void QuasiStaticBody::for_each_contact(const VisitContact& visit) const {
  TouchBody::for_each_contact(visit);
  if (patch_) patch_->for_each_contact(visit);
}

void QuasiStaticBody::for_each_force(const VisitForce& visit) const {
  TouchBody::for_each_force(visit);
  if (patch_) patch_->for_each_force(visit);
}

BodyPart::Capacity QuasiStaticBody::capacity() const {
  Capacity most = TouchBody::capacity();
  if (!patch_) return most;
  most.contacts += patch_->parts();
  most.forces += PatchTouch::kMaxForces * patch_->parts();
  return most;
}

bool QuasiStaticBody::by_patch(const TouchContact& contact) const {
  return patch_ && patch_->has(contact.tool_point().tool, contact.tool_point().part);
}

// A patch lies where its part is: of its contact only the shear goes on, and that within friction.
bool QuasiStaticBody::fits(const MovingTool& tool, std::span<const TouchContact> contacts) const {
  std::vector<TouchContact> by_mesh(contacts.begin(), contacts.end());
  std::erase_if(by_mesh, [this](const TouchContact& c) { return by_patch(c); });
  return TouchBody::fits(tool, by_mesh);
}

void QuasiStaticBody::adopt(std::span<const TouchContact> contacts) {
  std::vector<TouchContact> by_mesh;
  for (const TouchContact& c : contacts)
    if (by_patch(c))
      patch_->adopt(c);
    else
      by_mesh.push_back(c);
  TouchBody::adopt(by_mesh);
}

void QuasiStaticBody::settle(std::span<const MovingTool> tools) {
  stand(tools, settling_);
}

Eigen::Vector3d QuasiStaticBody::press_of(int tool) const {
  if (!patch_) return TouchBody::press_of(tool);
  Eigen::Vector3d sum = patch_->pressing(tool);
  for (const TouchContact& c : law().contacts())
    if (c.is_by(tool) && c.touch != Touch::open && !c.grasped) sum += c.force.dot(c.normal) * c.normal;
  return sum.isZero(0) ? sum : sum.normalized();
}

void QuasiStaticBody::state(State& s, std::span<const MovingTool> tools) {
  TouchBody::state(s, tools);
  if (patch_) patch_->state(s);
  if (memory_) memory_->state(s);
}

void QuasiStaticBody::load(std::span<const MovingTool> tools, std::span<ToolLoad> loads) const {
  TouchBody::load(tools, loads);
  if (patch_) patch_->load(tools, loads);
  if (!nonlinear_) return;
  for (int t = 0; t < static_cast<int>(loads.size()); ++t) {
    ToolLoad& load = loads[t];
    const double scale = correction_of(t).force_scale(-load.force.dot(load.press));
    load.force *= scale;
    load.torque *= scale;
  }
}

QuasiNonlinear QuasiStaticBody::correction_of(int tool) const {
  PressPlace place;
  const auto add = [&](int of_tool, int node, const Eigen::Vector3d& force) {
    if (of_tool == tool) place.add(map().position[node], force.norm());
  };
  for_each_force(std::ref(add));  // a reference, which takes no memory
  return nonlinear_->at(place.mean());
}

std::unique_ptr<BodyPart> make_haptic_part(const QuasiStaticSpec& spec, const Archive& archive,
                                           const StepSettings& settings) {
  return std::make_unique<QuasiStaticBody>(archive, spec, settings);
}

}  // namespace palpate
