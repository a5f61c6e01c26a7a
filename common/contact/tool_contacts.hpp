#pragma once
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "common/contact/contact_law.hpp"
#include "common/contact/touch_surface.hpp"
#include "common/scene/scene.hpp"
#include "common/tool/jaws.hpp"
#include "common/tool/moving_tool.hpp"

namespace palpate {

/// Finds which points of a moving surface the tools' spheres touch, and keeps the contacts of a ContactLaw in step with
/// them. Where triangles are smaller than a sphere their vertices carry the contact; where they are larger it touches at
/// one point of a triangle. Nothing is allocated after construction.
class ToolContacts {
 public:
  /// `spheres`: of all tools. The law outlives this object.
  ToolContacts(const SurfaceMap& map, double bucket_size, ContactLaw& law, std::size_t spheres);

  const TouchSurface& surface() const { return surface_; }
  /// Triangles near a point; ascending, valid until the next search.
  std::span<const int> near(const Eigen::Vector3d& centre, double radius) const { return surface_.find(centre, centre, radius); }

  /// Marks the nodes that are near the tools or carry a contact; the owner then works out where they are.
  std::span<const int> mark(std::span<const MovingTool> tools);
  /// Moves the marked nodes: three entries [m] per node.
  void move_marked(std::span<const double> displacement) { surface_.move_marked(displacement); }
  /// Finds what the tools touch and adds it to the law.
  void collide(std::span<const MovingTool> tools);
  /// Sets the contacts' targets before the law is solved.
  void aim(std::span<const MovingTool> tools);
  /// After the solve: sliding contacts move on along the sphere, those that have opened and gone are dropped.
  void settle(std::span<const MovingTool> tools);

  /// Jaws that close take the nodes between them, or the surface point nearest to their middle where triangles are
  /// larger than they are; true if there is something between them. `length` ahead of the tip, `width` across [m].
  /// Nodes for which `allowed` (int to bool) is false are left out.
  template <class Allowed>
  bool grasp(int tool, const Eigen::Isometry3d& pose, double length, double width, Allowed&& allowed) {
    const std::size_t first = law_.contacts().size();
    for (int node = 0; node < touchable_; ++node)
      if (allowed(node) && between_jaws(pose.inverse() * surface_.positions()[node], length, width))
        take_in_jaws(tool, pose, {{node, node, node}, Eigen::Vector3d::UnitX()}, false);
    return law_.contacts().size() > first || grasp_nearest(tool, pose, length);
  }
  void let_go(int tool);

  /// Surface and contacts as bytes, for replay.
  std::size_t state_size() const;
  void save(unsigned char* to) const;
  /// Throws std::runtime_error on a state that does not fit this surface and these tools.
  void restore(const unsigned char* from, std::span<const MovingTool> tools);

 private:
  void take_in_jaws(int tool, const Eigen::Isometry3d& pose, const Anchor& anchor, bool face);
  bool grasp_nearest(int tool, const Eigen::Isometry3d& pose, double length);
  void collide_sample(std::span<const MovingTool> tools, int tool, int sample, std::span<const int> near);
  bool add_crossing(const MovingTool& moving, int tool, int sample);
  void add_vertices(const Eigen::Vector3d& centre, double radius, double within, int tool, int sample, std::span<const int> near);
  void add_face(const Eigen::Vector3d& centre, double radius, double within, int tool, int sample, std::span<const int> near);
  bool taken_by_other(int tool, int sample, const std::array<int, 3>& nodes) const;
  void follow(int contact, const Eigen::Vector3d& centre, std::span<const int> near);
  Eigen::Vector3d inward(const TouchContact& contact) const;
  void aim(TouchContact& contact, const MovingTool& moving) const;
  double margin(double radius) const;
  double reach(const MovingTool& moving, int sample) const;
  const TouchContact* held_by(int tool, int sample) const;

  ContactLaw& law_;
  TouchSurface surface_;
  int touchable_, nodes_;
  double body_edge_;               ///< [m] mean edge of the surface at rest
  std::vector<double> mean_edge_;  ///< [m] per triangle, at rest
  std::vector<int> vertex_stamp_;
  int vertex_clock_ = 0;
  std::vector<int> near_;              ///< triangles near each sphere, sphere by sphere
  std::vector<std::size_t> near_end_;  ///< where each sphere's end in near_
};

/// Spheres of all tools of a scene.
std::size_t spheres_of(const Scene& scene);

/// [m] mean edge of a surface at rest.
double mean_edge(const SurfaceMap& map);

}  // namespace palpate
