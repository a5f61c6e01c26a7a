#include "common/models/deformer.hpp"

#include <algorithm>

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
    DeformableBody body{.map = archives[b].surface};
    if (!is_dynamic(scene.bodies[b])) body.compliance.emplace(archives[b], Compliance<float>::Rows::surface);
    if (scene.bodies[b].nonlinear) body.nonlinear = make_quasi_nonlinear(scene.bodies[b], archives[b]);
    const std::size_t nodes = body.map.position.size();
    body.surface.position.resize(nodes);
    body.surface.displacement.assign(nodes, Eigen::Vector3f::Zero());
    body.surface.normal.resize(nodes);
    bodies_.push_back(std::move(body));
  }
  deform();
}

bool Deformer::take(const ContactState& contacts) {
  for (const NodalForce& f : contacts.forces)
    if (f.body >= bodies_.size() || f.node >= bodies_[f.body].map.position.size()) return false;
  if (contacts.run != run_) contacts_.clear();
  run_ = contacts.run;
  contacts_[contacts.tool] = contacts;
  step_ = contacts.step;
  sense_ns_ = contacts.sense_ns;
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

void combine(const std::vector<const float*>& columns, const std::vector<float>& coefficients, std::vector<Eigen::Vector3f>& out) {
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

void Deformer::deform() {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    DeformableBody& body = bodies_[b];
    superpose(body, static_cast<std::uint32_t>(b));
    for (std::size_t n = 0; n < body.map.position.size(); ++n)
      body.surface.position[n] = body.map.position[n].cast<float>() + body.surface.displacement[n];
    vertex_normals(body.surface.position, body.map.triangles, body.surface.normal);
  }
}

}  // namespace palpate
