#include "common/sim/deformer.hpp"

#include <algorithm>
#include <utility>

#include "common/kernels/kernels.hpp"
#include "common/mesh/normals.hpp"

namespace palpate {

Eigen::Vector3d press_direction(const ContactState& contacts, std::uint32_t body) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const HeldContact& c : contacts.contacts) {
    if (c.body != body) continue;
    const Eigen::Map<const Eigen::Vector3d> force(c.force.data()), normal(c.normal.data());
    sum += force.dot(normal) * normal;
  }
  const double size = sum.norm();
  return size > 0 ? Eigen::Vector3d(sum / size) : Eigen::Vector3d::Zero();
}

Deformer::Deformer(const Scene& scene, const std::vector<Archive>& archives) {
  for (std::size_t b = 0; b < archives.size(); ++b) {
    const Body& from = scene.bodies[b];
    DeformableBody body{.map = archives[b].surface};
    if (const auto* spec = as<QuasiStaticSpec>(from)) {
      body.compliance.emplace(archives[b], Compliance<float>::Rows::surface);
      if (spec->nonlinear) body.nonlinear = make_quasi_nonlinear(*spec, archives[b]);
    }
    if (as<ModalShellSpec>(from)) body.modal.emplace(archives[b]);
    if (const auto* spec = as<CatheterSpec>(from)) body.tube.emplace(spec->catheter.particles, spec->catheter.radius);
    const std::size_t nodes = body.map.position.size();
    body.surface.position.resize(nodes);
    body.surface.displacement.assign(nodes, Eigen::Vector3f::Zero());
    body.surface.normal.resize(nodes);
    bodies_.push_back(std::move(body));
  }
  deform();
}

bool Deformer::fresh() const {
  return std::ranges::any_of(bodies_, &DeformableBody::fresh);
}

bool Deformer::has_modal_shells() const {
  return std::ranges::any_of(bodies_, [](const DeformableBody& body) { return body.modal.has_value(); });
}

bool Deformer::has_catheters() const {
  return std::ranges::any_of(bodies_, [](const DeformableBody& body) { return body.tube.has_value(); });
}

// Messages of several topics may arrive in any order: what is late of a run that has been followed by another is
// refused, unless it is newer than all else (a log that is played again).
bool Deformer::follow(std::uint64_t run, std::int64_t sense_ns) {
  if (run == run_) return true;
  if (std::ranges::find(past_runs_, run) != past_runs_.end() && sense_ns <= sense_ns_) return false;
  if (run_ != 0) past_runs_.push_back(run_);
  run_ = run;
  step_ = 0;
  contacts_.clear();
  for (DeformableBody& body : bodies_) {
    body.modes.reset();
    body.particles.clear();
    body.fresh = true;
  }
  return true;
}

void Deformer::show(std::uint64_t step, std::int64_t sense_ns) {
  if (step < step_) return;
  step_ = step;
  sense_ns_ = sense_ns;
}

bool Deformer::take(const ContactState& contacts) {
  for (const NodalForce& f : contacts.forces)
    if (f.body >= bodies_.size() || f.node >= bodies_[f.body].map.position.size()) return false;
  if (!follow(contacts.run, contacts.sense_ns)) return false;
  contacts_[contacts.tool] = contacts;
  for (DeformableBody& body : bodies_) {
    if (!body.compliance) continue;
    body.fresh = true;
    show(contacts.step, contacts.sense_ns);
  }
  return true;
}

bool Deformer::take(const ModalState& state) {
  if (state.body >= bodies_.size() || !bodies_[state.body].modal || !bodies_[state.body].modal->fits(state))
    return false;
  if (!follow(state.run, state.sense_ns)) return false;
  bodies_[state.body].modes = state;
  bodies_[state.body].fresh = true;
  show(state.step, state.sense_ns);
  return true;
}

bool Deformer::take(const CatheterState& state) {
  if (state.body >= bodies_.size() || !bodies_[state.body].tube) return false;
  DeformableBody& body = bodies_[state.body];
  if (state.position.size() != 3 * static_cast<std::size_t>(body.tube->particles())) return false;
  if (!follow(state.run, state.sense_ns)) return false;
  body.particles.resize(body.tube->particles());
  for (std::size_t i = 0; i < body.particles.size(); ++i)
    body.particles[i] = Eigen::Map<const Eigen::Vector3d>(&state.position[3 * i]);
  body.fresh = true;
  show(state.step, state.sense_ns);
  return true;
}

void Deformer::add_columns(DeformableBody& body, std::uint32_t index, const ContactState& contacts) {
  for (const NodalForce& f : contacts.forces) {
    if (f.body != index || static_cast<int>(f.node) >= body.compliance->column_nodes()) continue;
    for (int axis = 0; axis < 3; ++axis) {
      body.columns.push_back(body.compliance->column(static_cast<int>(f.node), axis));
      body.coefficients.push_back(static_cast<float>(f.force[axis]));
    }
  }
}

namespace {

void combine(const std::vector<const float*>& columns, const std::vector<float>& coefficients,
             std::vector<Eigen::Vector3f>& out) {
  kernels::active().combine_f(columns.data(), coefficients.data(), static_cast<int>(columns.size()),
                              3 * static_cast<std::ptrdiff_t>(out.size()), out.data()->data());
}

}  // namespace

void Deformer::superpose(DeformableBody& body, std::uint32_t index) {
  auto& total = body.surface.displacement;
  body.columns.clear();
  body.coefficients.clear();
  for (const auto& [tool, contacts] : contacts_) add_columns(body, index, contacts);
  if (body.columns.empty()) {
    std::fill(total.begin(), total.end(), Eigen::Vector3f::Zero());
    return;
  }
  combine(body.columns, body.coefficients, total);
  if (!body.nonlinear) return;

  body.linear = total;
  body.of_tool.resize(total.size());
  std::fill(total.begin(), total.end(), Eigen::Vector3f::Zero());
  for (const auto& [tool, contacts] : contacts_) {
    body.columns.clear();
    body.coefficients.clear();
    add_columns(body, index, contacts);
    if (body.columns.empty()) continue;
    combine(body.columns, body.coefficients, body.of_tool);
    const Eigen::Vector3d press = press_direction(contacts, index);
    for (std::size_t n = 0; n < total.size(); ++n)
      total[n] += body.nonlinear->correct(body.of_tool[n].cast<double>(), press).cast<float>();
  }
  // What is held stays where it is held.
  for (const auto& [tool, contacts] : contacts_)
    for (const NodalForce& f : contacts.forces)
      if (f.body == index) total[f.node] = body.linear[f.node];
}

void Deformer::rebuild(DeformableBody& body, std::uint32_t index) {
  DeformedSurface& surface = body.surface;
  if (body.tube && !body.particles.empty()) {
    body.tube->place(body.particles, surface.position, surface.normal);
    for (std::size_t n = 0; n < surface.position.size(); ++n)
      surface.displacement[n] = surface.position[n] - body.map.position[n].cast<float>();
    return;
  }
  if (body.compliance) {
    superpose(body, index);
  } else if (body.modal && body.modes) {
    body.modal->displace(*body.modes, surface.displacement);
  } else {
    std::ranges::fill(surface.displacement, Eigen::Vector3f::Zero());
  }
  for (std::size_t n = 0; n < surface.position.size(); ++n)
    surface.position[n] = body.map.position[n].cast<float>() + surface.displacement[n];
  vertex_normals(surface.position, body.map.triangles, surface.normal);
}

void Deformer::deform() {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    DeformableBody& body = bodies_[b];
    body.changed = std::exchange(body.fresh, false);
    if (body.changed) rebuild(body, static_cast<std::uint32_t>(b));
  }
}

}  // namespace palpate
