#include "common/models/quasi_static/quasi_static_body.hpp"

#include <algorithm>

#include "common/kernels/kernels.hpp"

namespace palpate {
namespace {

constexpr int kWholeColumnsFrom = 6;  // part of the touchable nodes, one in so many, from which whole columns are read

}  // namespace

QuasiStaticBody::QuasiStaticBody(const Archive& archive, const QuasiStaticSpec& body, const StepSettings& settings)
    : TouchBody(archive.surface, Compliance<double>(archive, Compliance<double>::Rows::touchable), settings) {
  if (body.nonlinear) nonlinear_ = make_quasi_nonlinear(body, archive);
  columns_.reserve(27 * kMaxContacts);
  coefficients_.reserve(27 * kMaxContacts);
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
  law().for_each_nodal_force([&](int contact, int node, const Eigen::Vector3d& f) {
    if (node >= compliance().column_nodes() || (tool >= 0 && !law().contacts()[contact].is_by(tool))) return;
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

void QuasiStaticBody::load(std::span<const MovingTool> tools, std::span<ToolLoad> loads) const {
  TouchBody::load(tools, loads);
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
