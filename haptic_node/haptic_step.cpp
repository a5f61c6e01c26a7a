#include "haptic_node/haptic_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace palpate {

HapticStep::HapticStep(const Scene& scene, const std::vector<Archive>& archives) : dt_(1.0 / scene.rates.haptic_hz) {
  for (const Tool& tool : scene.tools) {
    trocars_.push_back(make_trocar(tool.pivot, tool.axis, tool.up));
    tool_names_.push_back(tool.name);
    samples_.push_back(sample_tool(tool.radius, tool.shaft_radius, tool.shaft_length));
    safety_.emplace_back(tool.max_force, tool.max_force_rate, dt_);
    jaws_.push_back(tool.jaws);
  }
  for (const auto& samples : samples_) moving_.push_back({.samples = samples});
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    dynamic_.push_back(is_dynamic(scene.bodies[b]));
    bodies_.push_back(dynamic_[b] ? nullptr : std::make_unique<TouchBody>(archives[b], scene, static_cast<int>(b)));
    body_names_.push_back(scene.bodies[b].name);
  }
  if (std::ranges::count(dynamic_, 1) > 0)
    for (const Trocar& trocar : trocars_) local_.push_back(std::make_unique<LocalBody>(trocar, scene.contact.friction, dt_));
  loads_.resize(moving_.size());
  output_.resize(moving_.size());
  jaws_closed_.assign(moving_.size(), 0);
}

HapticStep::~HapticStep() = default;

void HapticStep::start(std::span<const ToolDofs> dofs, bool resuming) {
  if (!sense(dofs)) throw std::runtime_error("a tool's first pose is not a number");
  for (MovingTool& m : moving_) m.before = m.now;
  if (resuming) return;
  for (int t = 0; t < tools(); ++t)
    for (int s = 0; s < static_cast<int>(samples_[t].size()); ++s)
      for (int b = 0; b < bodies(); ++b) {
        if (!bodies_[b]) continue;
        const double depth = bodies_[b]->penetration(moving_[t].centre(moving_[t].now, s), samples_[t][s].radius);
        if (depth > 0)
          throw std::runtime_error(fmt::format("tool '{}' starts inside body '{}': its {} reaches {:.1f} mm into it", tool_names_[t],
                                               body_names_[b], s == 0 ? "tip" : "shaft", 1e3 * depth));
      }
}

void HapticStep::adopt(std::uint32_t tool, const HeldContact& held) {
  const bool fits = tool < moving_.size() && held.body < bodies_.size() && bodies_[held.body] && held.sample < samples_[tool].size();
  if (!fits) throw std::runtime_error("a peer keeps a contact of a tool or body that this scene does not have");
  TouchContact c{.tool = static_cast<int>(tool), .sample = static_cast<int>(held.sample)};
  const int nodes = static_cast<int>(bodies_[held.body]->surface().positions().size());
  for (int v = 0; v < 3; ++v) {
    if (static_cast<int>(held.nodes[v]) >= nodes) throw std::runtime_error("a peer keeps a contact on a node that the body lacks");
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
  std::uint32_t softened = 0;
  for (int t = 0; t < tools(); ++t) output_[t] = {};
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
  for (int t = 0; t < tools(); ++t) output_[t].flags |= softened | safety_[t].apply(output_[t].force, output_[t].torque, healthy);
  ++step_;
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

std::size_t HapticStep::state_size() const {
  std::size_t size = moving_.size() * (16 * sizeof(double) + sizeof(SafetyChain::State));
  for (const auto& body : bodies_)
    if (body) size += body->state_size();
  for (const auto& local : local_) size += local->state_size();
  return size + jaws_closed_.size() + (has_moving_tissue() ? sizeof step_ : 0);
}

void HapticStep::save(std::span<std::uint8_t> to) {
  std::uint8_t* p = to.data();
  for (int t = 0; t < tools(); ++t) {
    std::memcpy(p, moving_[t].now.data(), 16 * sizeof(double));
    p += 16 * sizeof(double);
    std::memcpy(p, &safety_[t].state(), sizeof(SafetyChain::State));
    p += sizeof(SafetyChain::State);
    *p++ = jaws_closed_[t];
  }
  for (auto& body : bodies_) {
    if (!body) continue;
    body->save(p);
    p += body->state_size();
  }
  for (auto& local : local_) {
    local->save(p);
    p += local->state_size();
  }
  if (has_moving_tissue()) std::memcpy(p, &step_, sizeof step_);
  forget_factors();
}

void HapticStep::forget_factors() {
  for (auto& body : bodies_)
    if (body) body->forget_factor();
}

void HapticStep::restore(std::span<const std::uint8_t> from) {
  if (from.size() != state_size()) throw std::runtime_error("the recorded state is of another scene (its size differs)");
  const std::uint8_t* p = from.data();
  for (int t = 0; t < tools(); ++t) {
    std::memcpy(moving_[t].now.data(), p, 16 * sizeof(double));
    moving_[t].before = moving_[t].now;
    p += 16 * sizeof(double);
    SafetyChain::State state;
    std::memcpy(&state, p, sizeof state);
    safety_[t].set_state(state);
    p += sizeof state;
    jaws_closed_[t] = *p++;
  }
  for (auto& body : bodies_) {
    if (!body) continue;
    body->restore(p, moving_);
    p += body->state_size();
  }
  for (auto& local : local_) {
    local->restore(p);
    p += local->state_size();
  }
  if (has_moving_tissue()) std::memcpy(&step_, p, sizeof step_);
}

}  // namespace palpate
