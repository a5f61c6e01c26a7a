#include "common/models/quasi_static/quasi_static_body.hpp"

#include <algorithm>

#include "common/kernels/kernels.hpp"

namespace palpate {
namespace {

bool by_patch(const StepSettings& settings) {
  return settings.contact.rule == "patch";
}

constexpr int kWholeColumnsFrom = 6;  // part of the touchable nodes, one in so many, from which whole columns are read

}  // namespace

QuasiStaticBody::QuasiStaticBody(const Archive& archive, const QuasiStaticSpec& body, const StepSettings& settings)
    : TouchBody(archive.surface, Compliance<double>(archive, Compliance<double>::Rows::touchable), settings,
                {.tips = !by_patch(settings)}) {
  const HalfSpace material{archive.young[0], archive.poisson[0]};
  if (by_patch(settings)) patch_ = std::make_unique<PatchTouch>(map(), compliance(), material, settings);
  if (body.nonlinear) nonlinear_ = make_quasi_nonlinear(body, archive);
  const std::size_t forces = 9 * kMaxContacts + (patch_ ? Patch::kMaxNodes * parts_of(settings.tools) : 0);
  columns_.reserve(3 * forces);
  coefficients_.reserve(3 * forces);
  displacement_.reserve(3 * map().size());
  of_tool_.reserve(3 * map().size());
  held_.reserve(map().size());
  whole_.assign(compliance().stride(), 0.0);
}

void QuasiStaticBody::update_surface(std::span<const MovingTool> tools) {
  const std::span<const int> marked = mark(tools);
  displacement_.assign(3 * marked.size(), 0.0);
  if (!nonlinear_) {
    superpose(-1, displacement_);
  } else {
    for (int t = 0; t < static_cast<int>(tools.size()); ++t) {
      superpose(t, of_tool_);
      const Eigen::Vector3d press = press_of(t);
      add_corrected<double>(*nonlinear_, of_tool_, press, displacement_);
    }
    superpose(-1, of_tool_);
    held_.clear();
    for (int i = 0; i < static_cast<int>(marked.size()); ++i)
      if (is_held(marked[i])) held_.push_back(i);
    keep_held<double>(held_, of_tool_, displacement_);
  }
  move_marked(displacement_);
}

bool QuasiStaticBody::is_held(int node) const {
  return std::ranges::any_of(law().contacts(), [&](const TouchContact& c) {
    const auto& n = c.anchor.nodes;
    return c.touch != Touch::open && (n[0] == node || (c.face && (n[1] == node || n[2] == node)));
  });
}

// u = sum C f over the contacts of one tool, or of all (-1), at the marked nodes.
void QuasiStaticBody::superpose(int tool, std::vector<double>& displacement) {
  columns_.clear();
  coefficients_.clear();
  for_each_force([this, tool](int of_tool, int node, const Eigen::Vector3d& f) {
    if (node >= compliance().column_nodes() || (tool >= 0 && of_tool != tool)) return;
    for (int axis = 0; axis < 3; ++axis) {
      columns_.push_back(compliance().column(node, axis));
      coefficients_.push_back(f[axis]);
    }
  });
  const std::span<const int> marked = surface().marked();
  const int count = static_cast<int>(columns_.size());
  displacement.resize(3 * marked.size());
  // Reading whole columns beats picking from them once a good part of the nodes is asked for.
  if (marked.size() * kWholeColumnsFrom < static_cast<std::size_t>(map().touchable)) {
    kernels::active().combine_nodes_d(columns_.data(), coefficients_.data(), count, marked.data(),
                                      static_cast<int>(marked.size()), displacement.data());
    return;
  }
  kernels::active().combine_d(columns_.data(), coefficients_.data(), count, 3 * map().touchable, whole_.data());
  for (std::size_t i = 0; i < marked.size(); ++i)
    std::copy_n(whole_.data() + 3 * marked[i], 3, displacement.data() + 3 * i);
}

// The patches first, against what the other contacts did in the last step; then those, on the tissue as the patches
// leave it.
LawOutcome QuasiStaticBody::hold(std::span<const MovingTool> tools) {
  if (!patch_) return TouchBody::hold(tools);
  patch_->touch(tools, [this](const VisitForce& visit) { TouchBody::for_each_force(visit); });
  for (const TouchContact& c : law().contacts())
    for (const int node : c.anchor.nodes) move_rest(node, patch_->displacement(node));
  return TouchBody::hold(tools);
}

void QuasiStaticBody::for_each_contact(const VisitContact& visit) const {
  TouchBody::for_each_contact(visit);
  if (patch_) patch_->for_each_contact(visit);
}

void QuasiStaticBody::for_each_force(const VisitForce& visit) const {
  TouchBody::for_each_force(visit);
  if (patch_) patch_->for_each_force(visit);
}

bool QuasiStaticBody::adopt(const TouchContact& contact) {
  return (patch_ && !contact.grasped && patch_->adopt(contact)) || TouchBody::adopt(contact);
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
}

void QuasiStaticBody::load(std::span<const MovingTool> tools, std::span<ToolLoad> loads) const {
  TouchBody::load(tools, loads);
  if (patch_) patch_->load(tools, loads);
  if (!nonlinear_) return;
  for (ToolLoad& load : loads) {
    const double scale = nonlinear_->force_scale(-load.force.dot(load.press));
    load.force *= scale;
    load.torque *= scale;
  }
}

std::unique_ptr<BodyPart> make_haptic_part(const QuasiStaticSpec& spec, const Archive& archive,
                                           const StepSettings& settings) {
  return std::make_unique<QuasiStaticBody>(archive, spec, settings);
}

}  // namespace palpate
