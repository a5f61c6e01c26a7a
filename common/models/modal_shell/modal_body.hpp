#pragma once
#include "common/contact/touch_body.hpp"
#include "common/contact/wall.hpp"
#include "common/models/modal_shell/modal_newmark.hpp"
#include "common/shell/spec.hpp"

namespace palpate {

/// One thin-walled duct under the hand, moved by its lowest modes (BHS01 sec. V-C-1 f-i), and the wall that catheters
/// meet.
///
/// The modes move by the trapezoidal rule, which is Newmark's average acceleration. Contacts are met at the step's end
/// velocity: what the law calls a position is p* = x + h v(t+h), and forces held over the step change it by
///   C* = R + Phi diag(4 / K^) Phi^T,   R = C - Phi Omega^-2 Phi^T,   K^ = omega^2 + 2 d/h + 4/h^2,
/// so that a touched body comes to rest on the tool. Meeting them in the end position by Phi K^^-1 Phi^T, as the
/// paper's scheme suggests, makes the force alternate from step to step for as long as the contact lasts.
class ModalBody : public TouchBody, public DuctWall {
 public:
  static constexpr int kMaxWallForces = 512;  ///< of catheters in a step

  /// `archive`: of a modal_shell, read with ArchivePart::touchable.
  ModalBody(const Archive& archive, const ShellSpec& body, const StepSettings& settings);

  void update_surface(std::span<const MovingTool> tools) override;
  LawOutcome hold(std::span<const MovingTool> tools) override;
  double penetration(const Segment& axis, double radius) const override;
  void settle(std::span<const MovingTool> tools) override;

  /// Forces of a catheter within this step; before hold().
  void push(std::span<const WallForce> forces) override;

  const TouchSurface& surface() const override { return TouchBody::surface(); }
  double half_thickness() const override { return half_thickness_; }
  double wall_radius() const override { return half_thickness_; }
  std::span<const double> free_motion() const override { return free_; }
  std::span<const double> inverse() const override { return constants_.inverse; }
  void rows(const Anchor& anchor, double* rows) const override;
  Eigen::Matrix3d residual(const Anchor& anchor) const override;
  std::span<const std::vector<int>> mouths() const override { return mouths_; }

  int modes() const { return static_cast<int>(x_.size()); }
  std::span<const double> coordinates() const override { return x_; }  ///< X [kg^1/2 m]
  double energy() const;                                               ///< [J] kinetic and elastic, of the modes

  DuctWall* wall() override { return this; }
  std::vector<BodyNews> news() const override;
  void tell(BodyMessage& message) override;

  /// What the full field is rebuilt from, u = Phi X' + C f: fills X' = X - Omega^-2 Phi^T f (one number a mode) and
  /// calls visit(node, f) for every node that carries a force [N]. Without residual flexibility X' = X, and there are
  /// none.
  template <class Visit>
  void show(double* coordinates, Visit&& visit) const {
    std::copy(x_.begin(), x_.end(), coordinates);
    if (!residual_) return;
    for (int m = 0; m < modes(); ++m) coordinates[m] -= (tool_force_[m] + wall_force_[m]) / constants_.omega2[m];
    law().for_each_nodal_force([&](int, int node, const Eigen::Vector3d& f) { visit(node, f); });
    for (const WallForce& w : pushed_)
      for (int v = 0; v < 3; ++v)
        if (w.anchor.weights[v] != 0) visit(w.anchor.nodes[v], Eigen::Vector3d(w.anchor.weights[v] * w.force));
  }

  void state(State& s, std::span<const MovingTool> tools) override;

 private:
  ModalBody(const Archive& archive, const ShellSpec& body, const StepSettings& settings, ModalConstants constants);

  std::size_t of_modes() const { return x_.size() * sizeof(double); }
  void tabulate_residuals();
  void add_residual(std::span<const int> near);
  void add_modal_force(int node, const Eigen::Vector3d& force, std::vector<double>& modal) const;
  Eigen::Vector3d modal_displacement(int node, const std::vector<double>& coordinates) const;

  struct TriangleResidual {
    std::array<int, 3> nodes;
    Eigen::Matrix<double, 9, 9> block;  ///< [m/N]
  };

  ModalConstants constants_;
  double dt_;
  bool residual_;
  double half_thickness_;
  std::vector<double> shape_;        ///< column-major, as in the archive
  std::vector<double> rows_;         ///< the same by rows: 3 x modes a node
  std::vector<int> first_triangle_;  ///< per node: where the triangles begin whose first corner it is
  std::vector<TriangleResidual> residuals_;
  std::vector<std::vector<int>> mouths_;
  std::vector<double> x_, v_;  ///< state, per mode
  std::vector<double> tool_force_,
      wall_force_;                    ///< [N kg^-1/2] modal forces of tools (last step's until hold()) and catheters
  std::vector<WallForce> pushed_;     ///< the wall forces of the step
  std::vector<double> free_, moved_;  ///< y of the coming step without the tools' new forces; x + y
  std::vector<double> all_, near_displacement_, displacement_, coefficients_;
  std::vector<const double*> columns_;
  std::vector<int> place_;  ///< per node: of its force in the message that is filled; -1: it has none
};

}  // namespace palpate
