#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "common/contact/contact_law.hpp"
#include "common/models/nonlinear.hpp"
#include "common/scene/scene.hpp"
#include "common/tensors/compliance.hpp"
#include "common/tool/instrument.hpp"
#include "haptic_node/touch_surface.hpp"

namespace palpate {

/// A tool as the contact search sees it: two poses and its spheres.
struct MovingTool {
  Eigen::Isometry3d before = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d now = Eigen::Isometry3d::Identity();
  std::span<const SampleSphere> samples;

  Eigen::Vector3d centre(const Eigen::Isometry3d& pose, int sample) const {
    return pose.translation() - samples[sample].behind * pose.linear().col(2);
  }
};

/// What one body does to one tool in a step. Linear and corrected forces share their direction of press.
struct ToolLoad {
  Eigen::Vector3d press = Eigen::Vector3d::Zero();   ///< unit or zero: common direction of the press on the tissue
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N] on the tool, after the non-linear correction
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m] on the tool about its tip, likewise
};

/// One quasi-static body under the hand: its tensors, the surface near the tools and the contacts.
class TouchBody {
 public:
  static constexpr int max_contacts = 96;

  TouchBody(const Archive& archive, const Scene& scene, int body);

  /// collide: brings the surface near the tools up to date and finds what they touch.
  void collide(std::span<const MovingTool> tools);
  /// hold: prescribes the contacts' displacements and solves for their forces.
  LawOutcome hold(std::span<const MovingTool> tools);
  /// force: sums what acts on each tool (one entry per tool).
  void load(std::span<const MovingTool> tools, std::span<ToolLoad> loads) const;

  const TouchSurface& surface() const { return surface_; }
  const ContactLaw& law() const { return law_; }
  /// Takes up a contact that a peer kept for this tool.
  void adopt(const TouchContact& contact) { law_.add(contact, std::span(contact.force.data(), 3)); }
  void forget_factor() { law_.forget_factor(); }
  /// Depth [m] to which a sphere reaches into the rest shape; 0 if it does not touch it.
  double penetration(const Eigen::Vector3d& centre, double radius) const;

  std::size_t state_size() const;
  void save(unsigned char* to) const;
  /// Throws std::runtime_error on a state that does not fit this body and these tools.
  void restore(const unsigned char* from, std::span<const MovingTool> tools);

 private:
  void update_surface(std::span<const MovingTool> tools);
  void superpose(int tool, std::vector<double>& displacement);
  void collide_sample(std::span<const MovingTool> tools, int tool, int sample, std::span<const int> near);
  bool add_crossing(const MovingTool& moving, int tool, int sample);
  void add_vertices(const Eigen::Vector3d& centre, double radius, double within, int tool, int sample, std::span<const int> near);
  void add_face(const Eigen::Vector3d& centre, double radius, double within, int tool, int sample, std::span<const int> near);
  bool taken_by_other(int tool, int sample, const std::array<int, 3>& nodes) const;
  void follow(int contact, const Eigen::Vector3d& centre, std::span<const int> near);
  Eigen::Vector3d inward(const TouchContact& contact) const;
  void aim(TouchContact& contact, const MovingTool& moving) const;
  void settle(std::span<const MovingTool> tools);
  double margin(double radius) const;
  double reach(const MovingTool& moving, int sample) const;
  const TouchContact* held_by(int tool, int sample) const;
  Eigen::Vector3d press_of(int tool) const;

  const SurfaceMap map_;
  Compliance<double> compliance_;
  TouchSurface surface_;
  ContactLaw law_;
  std::optional<QuasiNonlinear> nonlinear_;
  double body_edge_;  ///< [m] mean edge of the surface at rest
  std::vector<double> mean_edge_;  ///< [m] per triangle, at rest
  std::vector<int> vertex_stamp_;
  int vertex_clock_ = 0;
  std::vector<int> near_;              ///< triangles near each sphere, sphere by sphere
  std::vector<std::size_t> near_end_;  ///< where each sphere's end in near_
  std::vector<const double*> columns_;
  std::vector<double> coefficients_, displacement_, of_tool_, whole_;
};

}  // namespace palpate
