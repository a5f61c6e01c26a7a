#pragma once
#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/contact/tool_contacts.hpp"
#include "common/geometry/direction.hpp"
#include "common/tool/forceps.hpp"
#include "tests/haptic/synthetic_body.hpp"

namespace palpate::testing {

/// An open tube along x of n_around x n_along touchable nodes, its triangles looking outward, with the compliance of
/// flat_patch(): it serves tests of contact alone.
inline Archive tube(int n_around, int n_along, double radius, double length, double softness) {
  const double h = 2 * std::numbers::pi * radius / n_around;
  Archive a;
  a.body = "tube";
  for (int i = 0; i < n_along; ++i)
    for (int k = 0; k < n_around; ++k) {
      const double angle = 2 * std::numbers::pi * k / n_around;
      a.surface.position.emplace_back(length * (static_cast<double>(i) / (n_along - 1) - 0.5), radius * std::cos(angle),
                                      radius * std::sin(angle));
      a.surface.node_number.push_back(i * n_around + k);
      a.surface.fixed.push_back({false, false, false});
    }
  for (int i = 0; i + 1 < n_along; ++i)
    for (int k = 0; k < n_around; ++k) {
      const int p = i * n_around + k, q = i * n_around + (k + 1) % n_around;
      a.surface.triangles.push_back({p, q, q + n_around});
      a.surface.triangles.push_back({p, q + n_around, p + n_around});
    }
  a.surface.touchable = n_around * n_along;
  for (int node = 0; node < a.surface.touchable; ++node)
    for (int axis = 0; axis < 3; ++axis) a.touchable_dofs.push_back({node, axis});
  for (std::size_t i = 0; i < a.touchable_dofs.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const Dof p = a.touchable_dofs[i], q = a.touchable_dofs[j];
      const double r = (a.surface.position[p.node] - a.surface.position[q.node]).norm();
      a.touchable_compliance.push_back(p.axis == q.axis ? softness * std::exp(-r / (2 * h)) : 0.0);
    }
  return a;
}

/// Tools against one synthetic surface: a haptic step without its node.
class PatchTouch : public Stateful<PatchTouch> {
 public:
  PatchTouch(Archive archive, double friction, std::size_t parts, ToolContacts::Options options = {})
      : archive_(std::move(archive)),
        compliance_(archive_, Compliance<double>::Rows::touchable),
        response_(compliance_),
        surface_(archive_.surface, 2 * mean_edge(archive_.surface)),
        law_({response_, archive_.surface.position}, ContactLaw::Rule::barycentric, friction, 96),
        contacts_(surface_, law_, parts, std::move(options)) {
    displacement_.reserve(3 * archive_.surface.position.size());
  }

  LawOutcome step(std::span<const MovingTool> tools) {
    const auto marked = mark(surface_, contacts_, law_, tools);
    displacement_.assign(3 * marked.size(), 0.0);
    law_.for_each_nodal_force([&](int, int node, const Eigen::Vector3d& f) {
      for (int axis = 0; axis < 3; ++axis) {
        const double* column = compliance_.column(node, axis);
        for (std::size_t i = 0; i < marked.size(); ++i)
          for (int r = 0; r < 3; ++r) displacement_[3 * i + r] += column[3 * marked[i] + r] * f[axis];
      }
    });
    surface_.move_marked(displacement_);
    contacts_.collide(tools);
    contacts_.aim(tools);
    const LawOutcome outcome = law_.solve();
    contacts_.settle(tools);
    return outcome;
  }

  /// [N] of the normal forces alone on a tool: friction opposes a withdrawal too.
  Eigen::Vector3d pressure(int tool) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const TouchContact& c : law_.contacts())
      if (c.is_by(tool)) sum -= c.force.dot(c.normal) * c.normal;
    return sum;
  }
  /// [N], [N m] on a tool, about its tip frame's origin.
  Eigen::Vector3d force(int tool) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const TouchContact& c : law_.contacts())
      if (c.is_by(tool)) sum -= c.force;
    return sum;
  }
  Eigen::Vector3d torque(int tool, const Eigen::Vector3d& about) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const TouchContact& c : law_.contacts())
      if (c.is_by(tool)) sum -= (c.at - about).cross(c.force);
    return sum;
  }
  int pressing() const {
    int count = 0;
    for (const TouchContact& c : law_.contacts()) count += c.touch != Touch::open;
    return count;
  }

  void state(State& s, std::span<const MovingTool> tools = {}) {
    surface_.state(s);
    contacts_.state(s, tools);
  }

  const Archive& archive() const { return archive_; }
  const Compliance<double>& compliance() const { return compliance_; }
  ContactLaw& law() { return law_; }
  ToolContacts& contacts() { return contacts_; }
  const TouchSurface& surface() const { return surface_; }

 private:
  Archive archive_;
  Compliance<double> compliance_;
  CompliantResponse response_;
  TouchSurface surface_;
  ContactLaw law_;
  ToolContacts contacts_;
  std::vector<double> displacement_;
};

/// A tool of one segment along the tip frame's z axis, or a forceps, that is moved step by step.
class HandledTool {
 public:
  explicit HandledTool(std::vector<ToolPart> parts) : before_(parts), now_(std::move(parts)) {}
  static HandledTool segment(double length, double radius) {
    return HandledTool({{.length = length, .radius = radius}});
  }
  static HandledTool forceps(const ForcepsShape& shape, double opening) {
    const auto parts = forceps_parts(shape, opening);
    return HandledTool({parts.begin(), parts.end()});
  }

  /// The next step's pose: origin at `at`, z along `along`, turned about it by `roll` [rad].
  void move_to(const Eigen::Vector3d& at, const Eigen::Vector3d& along, double roll = 0) {
    pose_before_ = pose_;
    before_ = now_;
    pose_.linear() = (turn_between(Eigen::Vector3d::UnitZ(), along) * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()))
                         .toRotationMatrix();
    pose_.translation() = at;
  }
  void place_at(const Eigen::Vector3d& at, const Eigen::Vector3d& along, double roll = 0) {
    move_to(at, along, roll);
    pose_before_ = pose_;
  }
  void stay() {
    pose_before_ = pose_;
    before_ = now_;
  }
  void open(double opening) { set_opening(opening, now_); }  ///< after move_to() or stay()

  MovingTool moving() const { return {pose_before_, pose_, before_, now_}; }
  const Eigen::Isometry3d& pose() const { return pose_; }

 private:
  std::vector<ToolPart> before_, now_;
  Eigen::Isometry3d pose_before_ = Eigen::Isometry3d::Identity(), pose_ = pose_before_;
};

inline LawOutcome step(PatchTouch& touch, const HandledTool& tool) {
  const MovingTool moving = tool.moving();
  return touch.step({&moving, 1});
}

/// Lets a tool that stands still settle.
inline void settle(PatchTouch& touch, HandledTool& tool, int steps = 30) {
  for (int i = 0; i < steps; ++i) {
    tool.stay();
    step(touch, tool);
  }
}

}  // namespace palpate::testing
