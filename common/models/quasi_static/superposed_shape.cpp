#include "common/models/quasi_static/superposed_shape.hpp"

#include <algorithm>
#include <cmath>

#include "common/models/quasi_static/relaxing_shape.hpp"
#include "common/models/quasi_static/resolution.hpp"

namespace palpate {
namespace {

std::span<float> flat(std::vector<Eigen::Vector3f>& field) {
  return {field.data()->data(), 3 * field.size()};
}

}  // namespace

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

SuperposedShape::SuperposedShape(const QuasiStaticSpec& body, const Archive& archive, const StepSettings& settings)
    : BodyShape(archive.surface), sum_(archive) {
  if (body.nonlinear) nonlinear_ = make_nonlinear(body, archive);
  if (settings.contact.rule != ContactRule::patch) return;
  patches_ = patch_parts(settings.tools, true);
  if (!patch_parts(settings.tools, false).empty())
    fine_ = std::make_unique<FineDents>(map(), archive, HalfSpace{archive.young[0], archive.poisson[0]}, settings.tools,
                                        edges_resolved(offline_of(body, map().size())));
}

void SuperposedShape::displace(const ContactsOnBody& contacts, std::vector<Eigen::Vector3f>& total) {
  sum_.clear();
  for (const auto& [tool, state] : contacts.of_tool) sum_.add(state, contacts.body);
  sum_.combine(total);
  used_force_ = 0;
  if (nonlinear_ && !sum_.empty()) correct(contacts, total);
  if (!fine_) return;
  fine_->follow(contacts);
  fine_->add(total);
}

std::span<const HertzDent> SuperposedShape::dents() const {
  return fine_ ? fine_->dents() : std::span<const HertzDent>();
}

void SuperposedShape::correct(const ContactsOnBody& contacts, std::vector<Eigen::Vector3f>& total) {
  linear_ = total;
  of_tool_.resize(total.size());
  std::ranges::fill(total, Eigen::Vector3f::Zero());
  for (const auto& [tool, state] : contacts.of_tool) {
    sum_.clear();
    sum_.add(state, contacts.body);
    if (sum_.empty()) continue;
    sum_.combine(of_tool_);
    const Press press = press_of(state, contacts.body);
    add_corrected<float>(press.law, flat(of_tool_), press.direction, flat(total));
    used_force_ = std::max(used_force_, press.force / press.law.force_curve().end());
  }
  held_.clear();
  for (const auto& [tool, state] : contacts.of_tool)
    for (const HeldContact& c : state.contacts)
      for (int v = 0; v < 3 && c.body == contacts.body && !by_patch(state, c); ++v)
        if (c.weights[v] != 0) held_.push_back(static_cast<int>(c.nodes[v]));
  keep_held<float>(held_, flat(linear_), flat(total));
}

SuperposedShape::Press SuperposedShape::press_of(const ContactState& tool, std::uint32_t body) const {
  PressPlace place;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const NodalForce& f : tool.forces) {
    if (f.body != body) continue;
    const Eigen::Map<const Eigen::Vector3d> force(f.force.data());
    place.add(map().position[f.node], force.norm());
    sum += force;
  }
  const Eigen::Vector3d direction = press_direction(tool, body);
  return {nonlinear_->at(place.mean()), direction, std::abs(sum.dot(direction))};
}

bool SuperposedShape::by_patch(const ContactState& tool, const HeldContact& contact) const {
  if (contact.sticking == kInJaws) return false;
  return std::ranges::any_of(patches_, [&](const PatchPart& part) {
    return part.tool == static_cast<int>(tool.tool) && part.part == static_cast<int>(contact.sample);
  });
}

std::unique_ptr<BodyShape> make_shape(const QuasiStaticSpec& body, const Archive& archive,
                                      const StepSettings& settings) {
  if (body.relaxation) return std::make_unique<RelaxingShape>(archive);
  return std::make_unique<SuperposedShape>(body, archive, settings);
}

}  // namespace palpate
