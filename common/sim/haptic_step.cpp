#include "common/sim/haptic_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace palpate {
namespace {

constexpr double kWeightSlack = 1e-6;

double sum_of_force_limits(const Scene& scene) {
  double sum = 0;
  for (const Tool& tool : scene.tools) sum += tool.max_force;
  return sum;
}

using Rigs = std::vector<std::unique_ptr<ToolRig>>;

Rigs make_rigs(const Scene& scene, double dt) {
  Rigs rigs;
  for (const Tool& tool : scene.tools)
    rigs.push_back(std::make_unique<ToolRig>(static_cast<int>(rigs.size()), tool, dt));
  return rigs;
}

std::vector<Port*> ports_of(const Rigs& rigs) {
  std::vector<Port*> ports;
  for (const auto& rig : rigs) ports.push_back(&rig->port());
  return ports;
}

}  // namespace

HapticStep::HapticStep(const Scene& scene, const std::vector<Archive>& archives)
    : dt_(1.0 / scene.rates.haptic_hz),
      bodies_(static_cast<int>(scene.bodies.size())),
      rigs_(make_rigs(scene, dt_)),
      passivity_(scene.passivity, ports_of(rigs_), sum_of_force_limits(scene), dt_) {
  const StepSettings settings{scene.contact, scene.tools, dt_};
  std::vector<std::uint8_t> moving;
  std::vector<Eigen::Vector3d> gravity;
  for (int b = 0; b < bodies_; ++b) {
    const auto make = [&](const auto& spec) { return make_haptic_part(spec, archives[b], settings); };
    auto part = std::visit(make, scene.bodies[b]);
    moving.push_back(part == nullptr);
    gravity.push_back(std::visit([](const auto& spec) { return moving_gravity(spec); }, scene.bodies[b]));
    if (!part) continue;
    entries_.push_back({b, name_of(scene.bodies[b]), part.get()});
    parts_.push_back(std::move(part));
  }
  limits_ = std::make_unique<TissueLimits>(archives, moving, gravity);
  if (limits_->any()) {
    auto local = std::make_unique<LocalPart>(settings, *limits_);
    local_ = local.get();
    parts_.push_back(std::move(local));
  }
  for (const Entry& entry : entries_)
    entry.part->join([&](const std::string& name) -> BodyPart* {
      const auto of = std::ranges::find(entries_, name, &Entry::name);
      return of == entries_.end() ? nullptr : of->part;
    });
  seen_.resize(rigs_.size());
  loads_.resize(rigs_.size());
}

HapticStep::~HapticStep() = default;

const BodyPart* HapticStep::part(int body) const {
  const auto entry = std::ranges::find(entries_, body, &Entry::body);
  return entry == entries_.end() ? nullptr : entry->part;
}

std::vector<BodyNews> HapticStep::news() const {
  std::vector<BodyNews> all;
  for (const Entry& entry : entries_)
    for (BodyNews& news : entry.part->news()) {
      std::visit([&](auto& m) { m.body = static_cast<std::uint32_t>(entry.body); }, news.message);
      all.push_back(std::move(news));
    }
  return all;
}

void HapticStep::tell(BodyMessage& message) const {
  std::ranges::find(entries_, static_cast<int>(body_of(message)), &Entry::body)->part->tell(message);
}

void HapticStep::start(std::span<const ToolDofs> dofs) {
  place(dofs);
  if (const std::string inside = starts_inside(); !inside.empty()) throw std::runtime_error(inside);
}

void HapticStep::place(std::span<const ToolDofs> dofs) {
  for (int t = 0; t < tools(); ++t)
    if (!rigs_[t]->start(dofs[t])) throw std::runtime_error("a tool's first pose is not a number");
  see_tools();
}

std::string HapticStep::starts_inside() const {
  for (int t = 0; t < tools(); ++t)
    if (!rigs_[t]->resumed())
      if (std::string said = inside(t); !said.empty()) return said;
  return {};
}

std::string HapticStep::inside(int tool) const {
  const MovingTool& seen = seen_[tool];
  for (int p = 0; p < seen.size(); ++p)
    for (const Entry& entry : entries_) {
      const double depth = entry.part->penetration(seen.axis(p), seen.radius(p));
      if (depth > 0)
        return fmt::format("tool '{}' starts inside body '{}': its {} reaches {:.1f} mm into it", rigs_[tool]->name(),
                           entry.name, rigs_[tool]->end().part_name(p), 1e3 * depth);
    }
  return {};
}

bool HapticStep::is_sound(std::uint32_t tool, const HeldContact& held) const {
  if (held.body >= static_cast<std::uint32_t>(bodies_) || !part(static_cast<int>(held.body)) ||
      held.sample >= rigs_[tool]->end().parts().size())
    return false;
  constexpr auto most = static_cast<std::uint32_t>(std::numeric_limits<int>::max());
  const bool numbers = std::ranges::all_of(held.nodes, [](std::uint32_t n) { return n <= most; });
  const Eigen::Map<const Eigen::Vector3d> weights(held.weights.data()), at(held.offset.data()),
      normal(held.normal.data()), force(held.force.data());
  const bool within = weights.minCoeff() >= -kWeightSlack && std::abs(weights.sum() - 1) <= kWeightSlack;
  return numbers && within && std::abs(normal.norm() - 1) <= kWeightSlack &&
         rigs_[tool]->can_hold(static_cast<int>(held.sample), at) && force.norm() <= rigs_[tool]->max_force();
}

TouchContact HapticStep::contact_of(int tool, const HeldContact& held) const {
  TouchContact c{.by = ToolPoint{.tool = tool, .part = static_cast<int>(held.sample)}};
  for (int v = 0; v < 3; ++v) {
    c.anchor.nodes[v] = static_cast<int>(held.nodes[v]);
    c.anchor.weights[v] = held.weights[v];
    c.tool_point().offset[v] = held.offset[v];
    c.normal[v] = held.normal[v];
    c.force[v] = held.force[v];
  }
  c.face = held.nodes[0] != held.nodes[1];
  c.touch = held.sticking ? Touch::sticking : Touch::sliding;
  c.at = c.target = seen_[tool].to_world(c.tool_point().part, c.tool_point().offset);
  c.plane = c.normal.dot(c.target);
  return c;
}

bool HapticStep::resume(const ContactState& kept) {
  if (kept.tool >= rigs_.size()) return false;
  const int tool = static_cast<int>(kept.tool);
  if (rigs_[tool]->resumed() || inside(tool).empty()) return true;
  if (kept.contacts.empty() ||
      !std::ranges::all_of(kept.contacts, [&](const HeldContact& held) { return is_sound(kept.tool, held); }))
    return false;
  std::vector<std::vector<TouchContact>> of_part(entries_.size());
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    for (const HeldContact& held : kept.contacts)
      if (static_cast<int>(held.body) == entries_[e].body) of_part[e].push_back(contact_of(tool, held));
    if (!entries_[e].part->fits(seen_[tool], of_part[e])) return false;
  }
  for (std::size_t e = 0; e < entries_.size(); ++e) entries_[e].part->adopt(of_part[e]);
  rigs_[tool]->set_resumed();
  if (starts_inside().empty())
    for (auto& part : parts_) part->settle(seen_);
  return true;
}

void HapticStep::see_tools() {
  std::ranges::transform(rigs_, seen_.begin(), [](const auto& rig) { return rig->moving(); });
}

void HapticStep::step(std::span<const ToolDofs> dofs) {
  bool healthy = true;
  for (int t = 0; t < tools(); ++t) healthy &= rigs_[t]->sense(dofs[t]);
  for (auto& rig : rigs_) rig->work(parts_);
  count_energy();
  see_tools();
  healthy &= meet_bodies();
  give_forces(healthy);
  ++step_;
  const double largest = largest_force();
  for (auto& part : parts_) part->finish(largest, static_cast<double>(step_) * dt_);
}

// The last output was held while the tools moved to where they are.
void HapticStep::count_energy() {
  for (auto& rig : rigs_) rig->count_motion();
  passivity_.observe();
}

// Fills loads_ with what the bodies do to the tools. False if one of them is lost.
bool HapticStep::meet_bodies() {
  bool finite = true, softened = false;
  std::ranges::fill(loads_, ToolLoad{});
  for (auto& part : parts_) part->update_surface(seen_);
  for (auto& part : parts_) finite &= part->move(seen_, loads_);
  for (auto& part : parts_) {
    const LawOutcome outcome = part->touch({seen_, step_}, loads_);
    finite &= outcome.finite;
    softened |= outcome.raised > 0;
  }
  if (softened)
    for (ToolLoad& load : loads_) load.flags |= regularised;
  return finite;
}

// From what the tissue asks for to what the hand gets. Damping comes after the force limit, so that it knows what it
// damps, and before the slew limit and a second force limit, which have the last word; the energy counts what they
// leave.
void HapticStep::give_forces(bool healthy) {
  for (int t = 0; t < tools(); ++t) rigs_[t]->ask(loads_[t]);
  passivity_.control();
  for (auto& rig : rigs_) rig->give(healthy);
}

double HapticStep::largest_force() const {
  double largest = 0;
  for (const auto& rig : rigs_) largest = std::max(largest, rig->output().force.norm());
  return largest;
}

bool HapticStep::consume(const LocalContactModel& message) {
  if (!local_ || message.tool >= rigs_.size()) return false;
  LocalModel model;
  if (!copy_model(message, *limits_, model)) return false;
  consume(static_cast<int>(message.tool), model);
  return true;
}

void HapticStep::trip() {
  for (auto& rig : rigs_) rig->trip();
}

void HapticStep::state(State& s) {
  for (auto& rig : rigs_) rig->state(s);
  see_tools();
  for (auto& part : parts_) part->state(s, seen_);
  passivity_.state(s);
  s.value(step_);
}

std::size_t HapticStep::state_size() const {
  State s = State::measure();
  const_cast<HapticStep*>(this)->state(s);
  return s.size();
}

void HapticStep::save(std::span<std::uint8_t> to) {
  State s = State::save(to.data());
  state(s);
  forget_factors();
}

void HapticStep::forget_factors() {
  for (auto& part : parts_) part->forget_factor();
}

void HapticStep::restore(std::span<const std::uint8_t> from) {
  if (from.size() != state_size())
    throw std::runtime_error("the recorded state is of another scene (its size differs)");
  State s = State::restore(from.data());
  state(s);
}

}  // namespace palpate
