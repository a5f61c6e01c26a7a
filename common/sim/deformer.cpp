#include "common/sim/deformer.hpp"

#include <algorithm>
#include <utility>

#include "common/contact/step_settings.hpp"

namespace palpate {

namespace {

// By how much a message may come late behind one of another topic. What is further back is not late: the newer one told
// a time that was not true, or a log is played again.
constexpr std::int64_t kLateNs = 2'000'000'000;
constexpr std::uint64_t kLateSteps = 2000;
constexpr std::size_t kPastRuns = 16;

}  // namespace

Deformer::Deformer(const Scene& scene, const std::vector<Archive>& archives)
    : tools_(std::max<std::size_t>(scene.tools.size(), 1)) {
  const StepSettings settings{scene.contact, scene.tools, 1 / scene.rates.haptic_hz};
  for (std::size_t b = 0; b < archives.size(); ++b) {
    DeformableBody& body = bodies_.emplace_back();
    body.shape = std::visit([&](const auto& spec) { return make_shape(spec, archives[b], settings); }, scene.bodies[b]);
    const std::size_t nodes = body.shape->map().position.size();
    body.surface.position.resize(nodes);
    body.surface.displacement.assign(nodes, Eigen::Vector3f::Zero());
    body.surface.normal.resize(nodes);
  }
  deform();
}

bool Deformer::fresh() const {
  return std::ranges::any_of(bodies_, &DeformableBody::fresh);
}

bool Deformer::hears(const BodyMessage& message) const {
  return std::ranges::any_of(bodies_, [&](const DeformableBody& body) { return body.shape->hears(message); });
}

// Messages of several topics may arrive in any order: what is late of a run that has been followed by another is
// refused, unless it is newer than all else (a log that is played again).
bool Deformer::follow(std::uint64_t run, std::int64_t sense_ns) {
  if (run == run_) return true;
  const bool late = sense_ns <= sense_ns_ && sense_ns_ - sense_ns < kLateNs;
  if (late && std::ranges::find(past_runs_, run) != past_runs_.end()) return false;
  if (run_ != 0) past_runs_.push_back(run_);
  if (past_runs_.size() > kPastRuns) past_runs_.erase(past_runs_.begin());
  run_ = run;
  step_ = 0;
  contacts_.clear();
  for (DeformableBody& body : bodies_) {
    body.shape->reset();
    body.fresh = true;
  }
  return true;
}

void Deformer::show(std::uint64_t step, std::int64_t sense_ns) {
  if (step < step_ && step_ - step < kLateSteps) return;
  step_ = step;
  sense_ns_ = sense_ns;
}

bool Deformer::names_what_is_there(const ContactState& contacts) const {
  const auto there = [this](std::uint32_t body, std::uint32_t node) {
    return body < bodies_.size() && node < bodies_[body].shape->map().position.size();
  };
  return contacts.tool < tools_ &&
         std::ranges::all_of(contacts.forces, [&](const NodalForce& f) { return there(f.body, f.node); }) &&
         std::ranges::all_of(contacts.contacts, [&](const HeldContact& c) {
           return std::ranges::all_of(c.nodes, [&](std::uint32_t node) { return there(c.body, node); });
         });
}

bool Deformer::take(const ContactState& contacts) {
  if (!names_what_is_there(contacts)) return false;
  if (!follow(contacts.run, contacts.sense_ns)) return false;
  contacts_[contacts.tool] = contacts;
  for (DeformableBody& body : bodies_) {
    if (!body.shape->superposed()) continue;
    body.fresh = true;
    show(contacts.step, contacts.sense_ns);
  }
  return true;
}

bool Deformer::take(const BodyMessage& message) {
  const std::uint32_t of = body_of(message);
  if (of >= bodies_.size() || !bodies_[of].shape->fits(message)) return false;
  return std::visit(
      [&](const auto& m) {
        if (!follow(m.run, m.sense_ns)) return false;
        bodies_[of].shape->take(message);
        bodies_[of].fresh = true;
        show(m.step, m.sense_ns);
        return true;
      },
      message);
}

void Deformer::deform() {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    DeformableBody& body = bodies_[b];
    body.changed = std::exchange(body.fresh, false);
    if (body.changed) body.shape->rebuild({contacts_, static_cast<std::uint32_t>(b)}, body.surface);
  }
}

}  // namespace palpate
