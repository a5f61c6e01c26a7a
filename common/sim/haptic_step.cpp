#include "common/sim/haptic_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "common/models/quasi_static/quasi_static_body.hpp"
#include "common/tool/instrument.hpp"

namespace palpate {

namespace {

double most_force(const Scene& scene) {
  double sum = 0;
  for (const Tool& tool : scene.tools) sum += tool.max_force;
  return sum;
}

double least_slew(const Scene& scene) {
  double least = std::numeric_limits<double>::infinity();
  for (const Tool& tool : scene.tools) least = std::min(least, tool.max_force_rate);
  return least;
}

}  // namespace

HapticStep::HapticStep(const Scene& scene, const std::vector<Archive>& archives)
    : dt_(1.0 / scene.rates.haptic_hz),
      passivity_(scene.passivity, static_cast<int>(scene.tools.size()), most_force(scene), least_slew(scene), dt_) {
  for (const Tool& tool : scene.tools) {
    const bool forceps = tool.forceps() != nullptr;
    trocars_.push_back(make_trocar(tool.pivot, tool.axis, tool.up));
    tool_names_.push_back(tool.name);
    parts_.push_back(tool_parts(tool));
    shaft_length_.push_back(tool.shaft_length);
    tool_compliance_.push_back(tool.compliance);
    safety_.emplace_back(tool.max_force, tool.max_force_rate, dt_);
    jaws_.push_back(forceps ? std::nullopt : tool.probe()->jaws);
    hands_.emplace_back();
    if (forceps) hands_.back().emplace(static_cast<int>(hands_.size()) - 1, tool, dt_);
  }
  parts_before_ = parts_;
  for (std::size_t t = 0; t < parts_.size(); ++t)
    moving_.push_back({.parts_before = parts_before_[t], .parts = parts_[t]});
  const StepSettings settings{scene.contact, scene.tools, dt_};
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    const int index = static_cast<int>(b);
    dynamic_.push_back(as<MovingSpec>(body) != nullptr);
    body_names_.push_back(name_of(body));
    bodies_.emplace_back();
    modal_.push_back(nullptr);
    if (const auto* shell = as<ModalShellSpec>(body)) {
      auto modal = std::make_unique<ModalBody>(archives[b], *shell, settings);
      modal_.back() = modal.get();
      modal_bodies_.push_back({index, static_cast<std::size_t>(modal->modes())});
      bodies_.back() = std::move(modal);
    } else if (const auto* solid = as<QuasiStaticSpec>(body)) {
      bodies_.back() = std::make_unique<QuasiStaticBody>(archives[b], *solid, settings);
    }
  }
  build_catheters(scene);
  if (std::ranges::count(dynamic_, 1) > 0)
    for (const Trocar& trocar : trocars_)
      local_.push_back(std::make_unique<LocalBody>(trocar, scene.contact.friction, dt_));
  loads_.resize(moving_.size());
  output_.resize(moving_.size());
  motion_.resize(moving_.size());
  asked_.resize(moving_.size());
  handle_.assign(moving_.size(), 0.0);
  jaws_closed_.assign(moving_.size(), 0);
}

HapticStep::~HapticStep() = default;

void HapticStep::start(std::span<const ToolDofs> dofs, bool resuming) {
  if (!sense(dofs)) throw std::runtime_error("a tool's first pose is not a number");
  for (int t = 0; t < tools(); ++t) {
    moving_[t].before = moving_[t].now;
    if (!hands_[t]) continue;
    hands_[t]->start(dofs[t].grip);
    handle_[t] = hands_[t]->state().grip.commanded;
    set_opening(hands_[t]->opening(), parts_[t]);
    std::ranges::copy(parts_[t], parts_before_[t].begin());
  }
  if (resuming) return;
  for (int t = 0; t < tools(); ++t)
    for (int p = 0; p < moving_[t].size(); ++p)
      for (int b = 0; b < bodies(); ++b) {
        if (!bodies_[b]) continue;
        const double depth = bodies_[b]->penetration(moving_[t].axis(p), moving_[t].radius(p));
        if (depth > 0)
          throw std::runtime_error(fmt::format("tool '{}' starts inside body '{}': its {} reaches {:.1f} mm into it",
                                               tool_names_[t], body_names_[b], part_name(t, p), 1e3 * depth));
      }
}

// What a person calls a part of a tool.
const char* HapticStep::part_name(int tool, int part) const {
  if (hands_[tool]) return part == forceps_shaft ? "shaft" : "jaw";
  return part == 0 ? "tip" : "shaft";
}

void HapticStep::adopt(std::uint32_t tool, const HeldContact& held) {
  const bool fits =
      tool < moving_.size() && held.body < bodies_.size() && bodies_[held.body] && held.sample < parts_[tool].size();
  if (!fits) throw std::runtime_error("a peer keeps a contact of a tool or body that this scene does not have");
  TouchContact c{.tool = static_cast<int>(tool), .part = static_cast<int>(held.sample)};
  const int nodes = static_cast<int>(bodies_[held.body]->surface().positions().size());
  for (int v = 0; v < 3; ++v) {
    if (static_cast<int>(held.nodes[v]) >= nodes)
      throw std::runtime_error("a peer keeps a contact on a node that the body lacks");
    c.anchor.nodes[v] = static_cast<int>(held.nodes[v]);
    c.anchor.weights[v] = held.weights[v];
    c.offset[v] = held.offset[v];
    c.normal[v] = held.normal[v];
    c.force[v] = held.force[v];
  }
  c.face = held.nodes[0] != held.nodes[1];
  c.touch = held.sticking ? Touch::sticking : Touch::sliding;
  bodies_[held.body]->adopt(c);
}

// A pose that is not a number is a fault: the tool is taken to stand still.
bool HapticStep::sense(std::span<const ToolDofs> dofs) {
  bool healthy = true;
  for (int t = 0; t < tools(); ++t) {
    moving_[t].before = moving_[t].now;
    const Eigen::Isometry3d pose = tip_pose(trocars_[t], dofs[t]);
    const bool finite = pose.matrix().allFinite();
    if (finite) moving_[t].now = pose;
    healthy &= finite;
  }
  return healthy;
}

// Jaws that close hold what is between them, until they open.
void HapticStep::work_jaws(std::span<const ToolDofs> dofs) {
  for (int t = 0; t < tools(); ++t) {
    if (!jaws_[t]) continue;
    const bool closes = !jaws_closed_[t] && dofs[t].grip < jaws_[t]->closed_below;
    const bool opens = jaws_closed_[t] && dofs[t].grip > jaws_[t]->closed_below + jaw_slack;
    if (!closes && !opens) continue;
    jaws_closed_[t] = closes;
    for (auto& body : bodies_) {
      if (!body) continue;
      closes ? body->grasp(t, moving_[t].before, *jaws_[t]) : body->let_go(t);
    }
  }
}

void HapticStep::step(std::span<const ToolDofs> dofs) {
  bool healthy = sense(dofs);
  work_jaws(dofs);
  work_forceps(dofs);
  count_energy();
  std::uint32_t softened = 0;
  for (int t = 0; t < tools(); ++t) output_[t] = {};
  for (auto& body : bodies_)
    if (body) body->update_surface(moving_);
  healthy &= move_catheters();
  for (auto& body : bodies_) {
    if (!body) continue;
    body->collide(moving_);
    const LawOutcome outcome = body->hold(moving_);
    healthy &= outcome.finite;
    if (outcome.raised > 0) softened = regularised;
    body->load(moving_, loads_);
    for (int t = 0; t < tools(); ++t) {
      output_[t].force += loads_[t].force;
      output_[t].torque += loads_[t].torque;
      if (output_[t].press.isZero(0)) output_[t].press = loads_[t].press;
    }
  }
  for (int t = 0; t < static_cast<int>(local_.size()); ++t) {
    const ToolLoad load = local_[t]->load(moving_[t], step_);
    output_[t].force += load.force;
    output_[t].torque += load.torque;
    if (local_[t]->stale()) output_[t].flags = stale_model;
  }
  limit_forces(dofs, healthy, softened);
  keep_tasks();
  ++step_;
}

// The last output was held while the tools moved to where they are.
void HapticStep::count_energy() {
  for (int t = 0; t < tools(); ++t) {
    const double handle = hands_[t] ? hands_[t]->state().grip.commanded : 0.0;
    motion_[t] = motion_between(moving_[t].before, moving_[t].now, handle - handle_[t]);
    handle_[t] = handle;
  }
  passivity_.observe(motion_);
}

// From what the tissue asks for to what the hand gets. Damping comes after the force limit, so that it knows what it
// damps, and before the slew limit and a second force limit, which have the last word; the energy counts what they
// leave.
void HapticStep::limit_forces(std::span<const ToolDofs> dofs, bool healthy, std::uint32_t flags) {
  for (int t = 0; t < tools(); ++t) {
    asked_[t] = {output_[t].force, output_[t].torque, hands_[t] ? hands_[t]->torque() : 0.0};
    output_[t].flags |= flags | safety_[t].limit(asked_[t].force, asked_[t].torque);
  }
  passivity_.control(asked_);
  for (int t = 0; t < tools(); ++t) {
    Output& out = output_[t];
    PortForce& given = asked_[t];
    if (passivity_.limited(t)) out.flags |= passivity_limited;
    out.flags |= safety_[t].apply(given.force, given.torque, healthy);
    out.force = given.force;
    out.torque = given.torque;
    out.grip = given.grip;
    passivity_.hold(t, given);
    out.trocar = trocar_reaction(trocars_[t], dofs[t], shaft_length_[t], out.force, out.torque).trocar;
  }
}

bool HapticStep::consume(const LocalContactModel& message) {
  if (message.tool >= local_.size()) return false;
  LocalModel model;
  if (!copy_model(message, dynamic_, model)) return false;
  consume(static_cast<int>(message.tool), model);
  return true;
}

void HapticStep::trip() {
  for (SafetyChain& s : safety_) s.trip();
}

// What is kept beside tools, bodies and local models, in a fixed order.
template <class Visit>
void HapticStep::visit_extras(Visit&& visit) {
  visit(&step_, sizeof step_);
  for (Task& task : tasks_) visit(&task, sizeof task);
  for (int& contacts : wall_contacts_) visit(&contacts, sizeof contacts);
  for (double& handle : handle_) visit(&handle, sizeof handle);
}

std::size_t HapticStep::state_size() const {
  std::size_t size = moving_.size() * (16 * sizeof(double) + sizeof(SafetyChain::State)) + jaws_closed_.size();
  for (const auto& hand : hands_)
    if (hand) size += sizeof(ForcepsHand::State);
  for (const auto& body : bodies_)
    if (body) size += body->state_size();
  for (const auto& catheter : catheters_)
    if (catheter) size += catheter->state_size();
  for (const auto& local : local_) size += local->state_size();
  return size + passivity_.state_size() + handle_.size() * sizeof(double) + sizeof step_ +
         tasks_.size() * (sizeof(Task) + sizeof(int));
}

void HapticStep::save(std::span<std::uint8_t> to) {
  std::uint8_t* p = to.data();
  const auto put = [&p](const void* from, std::size_t size) {
    std::memcpy(p, from, size);
    p += size;
  };
  for (int t = 0; t < tools(); ++t) {
    put(moving_[t].now.data(), 16 * sizeof(double));
    put(&safety_[t].state(), sizeof(SafetyChain::State));
    *p++ = jaws_closed_[t];
    if (hands_[t]) put(&hands_[t]->state(), sizeof(ForcepsHand::State));
  }
  const auto save_all = [&p](auto& items) {
    for (auto& item : items) {
      if (!item) continue;
      item->save(p);
      p += item->state_size();
    }
  };
  save_all(bodies_);
  save_all(catheters_);
  save_all(local_);
  passivity_.save(p);
  p += passivity_.state_size();
  visit_extras(put);
  forget_factors();
}

void HapticStep::forget_factors() {
  for (auto& body : bodies_)
    if (body) body->forget_factor();
}

void HapticStep::restore(std::span<const std::uint8_t> from) {
  if (from.size() != state_size())
    throw std::runtime_error("the recorded state is of another scene (its size differs)");
  const std::uint8_t* p = from.data();
  const auto get = [&p](void* to, std::size_t size) {
    std::memcpy(to, p, size);
    p += size;
  };
  for (int t = 0; t < tools(); ++t) {
    get(moving_[t].now.data(), 16 * sizeof(double));
    moving_[t].before = moving_[t].now;
    SafetyChain::State state;
    get(&state, sizeof state);
    safety_[t].set_state(state);
    jaws_closed_[t] = *p++;
    if (!hands_[t]) continue;
    ForcepsHand::State hand;
    get(&hand, sizeof hand);
    hands_[t]->set_state(hand);
    set_opening(hand.grip.opening, parts_[t]);
    std::ranges::copy(parts_[t], parts_before_[t].begin());
  }
  for (auto& body : bodies_) {
    if (!body) continue;
    body->restore(p, moving_);
    p += body->state_size();
  }
  for (auto& catheter : catheters_) {
    if (!catheter) continue;
    catheter->restore(p);
    p += catheter->state_size();
  }
  for (auto& local : local_) {
    local->restore(p);
    p += local->state_size();
  }
  passivity_.restore(p);
  p += passivity_.state_size();
  visit_extras(get);
}

}  // namespace palpate
