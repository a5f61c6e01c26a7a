#include "common/models/moving/dynamic_organ.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "common/mesh/normals.hpp"
#include "common/models/moving/tissue_steps.hpp"
#include "common/models/moving_kind.hpp"
#include "common/tool/instrument.hpp"
#include "common/tool/jaws.hpp"

namespace palpate {
namespace {

constexpr double kLostBeyond = 3;           // diagonals from its place, beyond which a part that floats is taken away
constexpr int kMaxCuts = 4, kMaxTears = 8;  // tetrahedra that one tick takes away, conformity's apart
constexpr double kCalmed = 0.6;             // [s] for which tissue is calmed into which a tool was put: it is led out

}  // namespace

DynamicOrgan::DynamicOrgan(const Archive& archive, const MovingSpec& body, const StepSettings& settings,
                           const MakeModel& make)
    : name_(body.name),
      mesh_(elastic_mesh(archive, body.dynamic.element)),
      topology_(mesh_.tetrahedra, mesh_.nodes()),
      shown_(archive.surface.triangles, topology_),
      surface_(topology_, mesh_.rest, bucket_size(settings.contact, archive.surface)),
      model_(make(mesh_)),
      still_(archive.hybrid ? std::make_unique<HybridTouch>(archive, settings,
                                                            body.dynamic.precision == Precision::float32, *model_)
                            : nullptr),
      contacts_(archive, mesh_, topology_, surface_, *model_, still_.get(), settings),
      passing_(surface_, settings.tools.size()),
      fading_(settings.dt),
      position_(mesh_.rest),
      in_tick_(settings.tools.size()),
      in_step_(settings.tools.size()) {
  for (const Tool& tool : settings.tools) {
    const EndAbilities can = abilities_of(tool);
    hands_.push_back({.closing = can.closing, .turning = forceps_shape(tool), .cautery = can.cautery});
  }
  if (still_) topology_.join(shown_.joints());
  surface_.hide(shown_.joints());
  for (int node = 0; node < mesh_.nodes(); ++node)
    if (std::ranges::all_of(mesh_.fixed[node], std::identity{})) surface_.fix(node);
  damping_ = body.dynamic.damping;
  const TissueSteps steps = tissue_steps(name_, body.dynamic, model_->frequency_bound());
  max_step_ = steps.free;
  touched_step_ = steps.touched;
  if (body.tearing) tearing_.emplace(mesh_, body.tearing->criterion, body.tearing->threshold, kMaxTears);
  Eigen::Vector3d low = mesh_.rest[0], high = low;
  for (const Eigen::Vector3d& x : mesh_.rest) low = low.cwiseMin(x), high = high.cwiseMax(x);
  diagonal_ = (high - low).norm();
  middle_ = 0.5 * (low + high);
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
    contacts_.drop_tool(t);
    if (still_) still_->drop_tool(t);
  }
}

void DynamicOrgan::meet(std::span<const ToolInTick> tools) {
  passing_.meet(tools, !removed_.empty(), [&](int t) { return ToolDeed{holds(t), glows(t, tools[t])}; });
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
  advance(tools, dt);
  if (put_into(tools)) calm_left_ = kCalmed;
  // What jaws carry goes with them: stopped, it would be a blow to the hand.
  if (calm_left_ > 0 && std::ranges::none_of(hands_, &Hand::holding)) calm();
  calm_left_ = std::max(calm_left_ - dt, 0.0);
  cut(tools);
  tear();
  drop_fallen();
}

// A tool that no motion has led here touches: what it pressed before swings, and what it is put into would.
bool DynamicOrgan::put_into(std::span<const ToolInTick> tools) const {
  const auto is_new = [&](const TouchContact& c) { return tools[c.tool_point().tool].begins; };
  return std::ranges::any_of(contacts(), is_new) || (still_ && std::ranges::any_of(still_->contacts(), is_new));
}

void DynamicOrgan::settle(std::span<const ToolInTick> tools, double dt) {
  advance(tools, dt);
  tear();
  drop_fallen();
  calm();
}

void DynamicOrgan::advance(std::span<const ToolInTick> tools, double dt) {
  changes_.clear();
  take_tools(tools);
  work_jaws(tools);
  let_pass(tools);
  load();
  if (still_) still_->find(in_tick_);
  contacts_.find(in_tick_, dt / steps_in(dt, true), [this](int tool) { return holds(tool); });
  const bool touched = contacts_.touched();
  const int steps = steps_in(dt, touched);
  in_step_ = in_tick_;
  for (MovingTool& tool : in_step_) tool.now = tool.before;
  for (int s = 1; s <= steps; ++s) {
    move_tools(static_cast<double>(s) / steps);
    if (still_) still_->hold(in_step_);
    for (FloatingPart& part : floating_) part.give_back_damping(*model_, mesh_.rest);
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
  if (!std::ranges::all_of(removed, [&](std::uint32_t t) { return t < static_cast<std::uint32_t>(topology_.size()); }))
    return false;
  topology_.erase(std::vector<int>(removed.begin(), removed.end()));
  std::vector<char> listed(topology_.size(), 0);
  for (const std::uint32_t t : removed)
    if (!std::exchange(listed[t], 1)) removed_.push_back(static_cast<int>(t));
  surface_.follow();
  note_change(RemovalCause::gone_before, 0);
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
  surface_.set_positions(position_);
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
  if (take(contacts_.search(), [&](int node) { return topology_.has_node(node); }) || !still_) return;
  take(still_->search(), [&](int node) { return still_->part().owns(node); });
}

Eigen::Vector3d DynamicOrgan::position(int node) const {
  if (still_ && still_->part().owns(node)) return mesh_.rest[node] + still_->part().displacement(node);
  return surface_.positions()[node];
}

Eigen::Vector3d DynamicOrgan::displacement(int node) const {
  return still_ && still_->part().owns(node) ? still_->part().displacement(node) : model_->displacement(node);
}

bool DynamicOrgan::holds(int tool) const {
  return contacts_.grasping(tool) || (still_ && still_->grasping(tool));
}

// Cautery takes the tetrahedra whose visible facets the glowing sphere touches.
void DynamicOrgan::cut(std::span<const ToolInTick> tools) {
  const std::size_t first = removed_.size();
  for (std::size_t t = 0; t < tools.size(); ++t) {
    const auto& cautery = hands_[t].cautery;
    if (!tools[t].present || !glows(static_cast<int>(t), tools[t])) continue;
    for (int i = 0; i < kMaxCuts; ++i) {
      const Eigen::Vector3d tip = in_tick_[t].now.translation();
      double least = cautery->radius * cautery->radius;
      int nearest = -1;
      for (int facet : surface_.find(tip, tip, cautery->radius)) {
        const double squared = closest_point(tip, surface_.corners(facet)).squared_distance;
        if (squared >= least) continue;
        least = squared;
        nearest = facet;
      }
      if (nearest < 0) break;
      remove(nearest / 4);
    }
  }
  note_change(RemovalCause::cut, first);
}

void DynamicOrgan::tear() {
  if (!tearing_) return;
  const std::size_t first = removed_.size();
  for (int t : tearing_->find(position_))
    if (topology_.alive(t)) remove(t);
  note_change(RemovalCause::torn, first);
}

void DynamicOrgan::remove(int tetrahedron) {
  topology_.remove(tetrahedron, removed_);
  surface_.follow();
}

void DynamicOrgan::note_change(RemovalCause cause, std::size_t first) {
  if (first == removed_.size()) return;
  changes_.push_back({cause, {removed_.begin() + static_cast<std::ptrdiff_t>(first), removed_.end()}});
  if (cause == RemovalCause::cut)
    cut_from_model(changes_.back().removed);
  else
    model_->remove(changes_.back().removed);
  if (tearing_) tearing_->remove(changes_.back().removed);
  for (const auto& [node, force] : contacts_.follow_cut(topology_))
    if (fades(node)) fading_.add(node, force);
  follow_change();
}

bool DynamicOrgan::fades(int node) const {
  return topology_.has_node(node) && !(still_ && std::ranges::count(still_->part().connection(), node) > 0);
}

// What the tetrahedra did to the nodes that stay fades; gone at once, it would be a blow to what presses them.
void DynamicOrgan::cut_from_model(std::span<const int> gone) {
  std::vector<int> nodes;
  for (const int t : gone) nodes.insert(nodes.end(), mesh_.tetrahedra[t].begin(), mesh_.tetrahedra[t].end());
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  std::erase_if(nodes, [&](int n) { return !fades(n); });
  std::vector<Eigen::Vector3d> before;
  for (const int n : nodes) before.push_back(model_->elastic_force(n));
  model_->remove(gone);
  for (std::size_t i = 0; i < nodes.size(); ++i) fading_.add(nodes[i], before[i] - model_->elastic_force(nodes[i]));
}

// What has been cut away fades, and what floats is damped for its swinging alone.
void DynamicOrgan::load() {
  for (const FloatingPart& part : floating_) part.unload(*model_);
  fading_.fade(*model_);
  for (FloatingPart& part : floating_) part.keep_loads(*model_);
}

// Which parts float now.
void DynamicOrgan::follow_change() {
  const int parts = topology_.parts(part_of_);
  std::vector<char> held(parts, 0), listed(mesh_.nodes(), 0);
  std::vector<std::vector<int>> nodes(parts);
  for (int t = 0; t < topology_.size(); ++t) {
    const int part = part_of_[t];
    if (part < 0) continue;
    for (int node : topology_.tetrahedron(t)) {
      held[part] |= mesh_.fixed[node][0] || mesh_.fixed[node][1] || mesh_.fixed[node][2];
      if (!std::exchange(listed[node], 1)) nodes[part].push_back(node);
    }
    for (int f = 0; f < 4; ++f) held[part] |= is_joint(4 * t + f);
  }
  floating_.clear();
  for (int part = 0; part < parts; ++part)
    if (!held[part]) floating_.emplace_back(std::move(nodes[part]), damping_);
}

// A part that floats and has gone far away is not followed for ever.
void DynamicOrgan::drop_fallen() {
  const std::size_t first = removed_.size();
  for (const FloatingPart& part : floating_) {
    const Eigen::Vector3d& at = position_[part.nodes()[0]];
    if ((at - middle_).squaredNorm() < kLostBeyond * kLostBeyond * diagonal_ * diagonal_) continue;
    std::vector<char> of_it(mesh_.nodes(), 0);
    for (const int n : part.nodes()) of_it[n] = 1;
    std::vector<int> gone;
    for (int t = 0; t < topology_.size(); ++t)
      if (topology_.alive(t) && of_it[topology_.tetrahedron(t)[0]]) gone.push_back(t);
    topology_.erase(gone);
    surface_.follow();
    removed_.insert(removed_.end(), gone.begin(), gone.end());
  }
  note_change(RemovalCause::fell_away, first);
}

void DynamicOrgan::shape(std::vector<Eigen::Vector3f>& position, std::vector<Eigen::Vector3f>& normal) {
  position.resize(position_.size());
  normal.resize(position_.size());
  for (std::size_t n = 0; n < position_.size(); ++n) position[n] = position_[n].cast<float>();
  if (still_) still_->shape(mesh_.rest, position);
  vertex_normals(position, shown_.triangles(topology_), normal);
}

std::vector<std::uint8_t> DynamicOrgan::motion() const {
  std::vector<std::uint8_t> bytes(model_->state_size());
  model_->save(bytes.data());
  return bytes;
}

DynamicOrgan::Memory DynamicOrgan::memory() const {
  std::vector<char> holding;
  for (const Hand& hand : hands_) holding.push_back(hand.holding);
  return {removed_,
          motion(),
          holding,
          {surface_.previous().begin(), surface_.previous().end()},
          {surface_.positions().begin(), surface_.positions().end()}};
}

void DynamicOrgan::state(State& s, std::span<const MovingTool> tools) {
  Memory m = s.restoring() ? Memory{} : memory();
  s.list(m.removed);
  fading_.state(s);
  s.list(m.motion);
  s.list(m.holding);
  passing_.state(s);
  s.value(calm_left_);
  s.value(moved_with_);
  s.list(m.previous);
  s.list(m.present);
  if (s.restoring()) recall(m);
  contacts_.state(s, tools);
  if (still_) still_->state(s, tools);
}

// Whether what was read can be of this body and these tools.
bool DynamicOrgan::fits(const Memory& m) const {
  const bool sizes = m.motion.size() == model_->state_size() && m.holding.size() == hands_.size() &&
                     passing_.fits(hands_.size()) && m.previous.size() == position_.size() &&
                     m.present.size() == position_.size();
  return sizes && fading_.fits(mesh_.nodes()) &&
         std::ranges::all_of(m.removed, [&](int t) { return t >= 0 && t < topology_.size(); });
}

void DynamicOrgan::recall(const Memory& m) {
  if (!fits(m) || !removed_.empty())
    throw std::runtime_error(fmt::format("the recorded state is not one of body '{}'", name_));
  removed_ = m.removed;
  topology_.erase(removed_);
  surface_.follow();
  model_->remove(removed_);
  if (tearing_) tearing_->remove(removed_);
  model_->restore(m.motion.data());
  for (std::size_t t = 0; t < hands_.size(); ++t) hands_[t].holding = m.holding[t] != 0;
  surface_.set_positions(m.previous);
  surface_.set_positions(m.present);
  position_ = m.present;
  contacts_.follow_cut(topology_);
  follow_change();
}

std::uint64_t DynamicOrgan::hash() const {
  const std::vector<std::uint8_t> state = motion();
  return XXH3_64bits(state.data(), state.size()) ^ XXH3_64bits(removed_.data(), removed_.size() * sizeof(int));
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
