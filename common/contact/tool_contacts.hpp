#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "common/contact/body_part.hpp"
#include "common/contact/contact_law.hpp"
#include "common/contact/spec.hpp"
#include "common/contact/touch_surface.hpp"
#include "common/geometry/segment.hpp"
#include "common/tool/jaws.hpp"
#include "common/tool/moving_tool.hpp"
#include "common/tool/spec.hpp"

namespace palpate {

/// Finds which points of a moving surface the parts of tools touch, and keeps the contacts of a ContactLaw in step with
/// them. Where triangles are smaller than a part's radius their vertices carry the contact; where they are larger a
/// sphere touches at one point of a triangle, and a segment at one point of each triangle along it (BHS01 sec. VII).
/// Nothing is allocated after construction.
class ToolContacts {
 public:
  /// What a body's tools have in common with one another, and what is each tool's own.
  struct Options {
    double offset = 0;  ///< [m] half the thickness of a wall whose middle surface this is: added to all radii
    std::vector<double> softness;  ///< [m/N] per tool; empty: tools are rigid
    /// [m/N] By which the tissue gives way under a part of a radius [m] that rests on a point of a triangle, beyond
    /// what its nodes do. Empty: not at all.
    std::function<double(double radius)> face_give;
    /// Whether a part of a tool touches a triangle otherwise. Empty: none does.
    std::function<bool(int tool, int part, int triangle)> elsewhere;
  };

  /// `parts`: of all tools. Surface and law outlive this object.
  ToolContacts(const ContactSurface& surface, ContactLaw& law, std::size_t parts, Options options);
  ToolContacts(const ContactSurface& surface, ContactLaw& law, std::size_t parts)
      : ToolContacts(surface, law, parts, Options{}) {}

  /// Finds the triangles near the tools: what collide() looks at. Valid until the next call.
  std::span<const int> look(std::span<const MovingTool> tools);
  /// Finds what the tools touch and adds it to the law.
  void collide(std::span<const MovingTool> tools);
  /// Sets the contacts' targets before the law is solved.
  void aim(std::span<const MovingTool> tools);
  /// After a solve that another one follows for the same contacts, the surface being where it is then: what slides
  /// moves on, and so does what has opened.
  void slide(std::span<const MovingTool> tools);
  /// After the last solve: sliding contacts move on along their parts, those that have opened and gone are dropped.
  void settle(std::span<const MovingTool> tools);
  /// Takes up a contact that was kept elsewhere, with its targets; its offset must be in its part's frame.
  void adopt(TouchContact contact);

  /// Jaws that close take the nodes between them, or the surface point nearest to their middle where triangles are
  /// larger than they are; true if there is something between them. `length` ahead of the tip, `width` across [m].
  /// Nodes for which `allowed` (int to bool) is false are left out.
  template <class Allowed>
  bool grasp(int tool, const Eigen::Isometry3d& pose, double length, double width, Allowed&& allowed) {
    const auto between = [&](const Eigen::Vector3d& p) { return between_jaws(p, length, width); };
    return take_nodes(tool, pose, between, allowed) || grasp_nearest(tool, pose, length);
  }
  /// The same for the jaws of a forceps.
  template <class Allowed>
  bool grasp(const OpenJaws& jaws, Allowed&& allowed) {
    const auto between = [&](const Eigen::Vector3d& p) { return between_jaws(jaws.shape, jaws.opening, p); };
    return take_nodes(jaws.tool, jaws.pose, between, allowed) ||
           grasp_nearest(jaws.tool, jaws.pose, jaws.shape.jaw_length);
  }
  /// The nodes between jaws of another shape: those for which `between` (point in the tip frame [m] to bool) and
  /// `allowed` are true; true if there are any.
  template <class Between, class Allowed>
  bool take_nodes(int tool, const Eigen::Isometry3d& pose, Between&& between, Allowed&& allowed) {
    const std::size_t first = law_.contacts().size();
    for (int node = 0; node < surface_.nodes(); ++node)
      if (surface_.touchable(node) && allowed(node) &&
          between(Eigen::Vector3d(pose.inverse() * surface_.positions()[node])))
        take_in_jaws(tool, pose, {{node, node, node}, Eigen::Vector3d::UnitX()}, false);
    return law_.contacts().size() > first;
  }
  /// A point of the surface that is held between jaws from now on; it stays where it is in the tip frame. False if
  /// there is no room for another contact.
  bool take_in_jaws(int tool, const Eigen::Isometry3d& pose, const Anchor& anchor, bool face);
  /// The surface point nearest to the jaws' middle; false if it is farther than half their length.
  bool grasp_nearest(int tool, const Eigen::Isometry3d& pose, double length);
  void let_go(int tool);

  /// The contacts of the law, for replay. Restoring throws std::runtime_error on a state that does not fit this surface
  /// and these tools.
  void state(State& s, std::span<const MovingTool> tools = {});

 private:
  static constexpr int kMaxSwept = 512;  ///< points of a segment, less one, that are swept

  struct Candidate {
    int triangle;
    double share, squared_distance;
  };
  /// Where a point passes the surface for the first time in a step.
  struct Crossing {
    int triangle = -1;
    double time = 2;
    Eigen::Vector3d weights = Eigen::Vector3d::Zero();

    void meet(int t, const std::optional<SweptHit>& hit) {
      if (hit && hit->from_outside && hit->time < time) *this = {t, hit->time, hit->weights};
    }
  };

  /// A place along a part, and on which side of it.
  struct Place {
    double along;          ///< [m]
    Eigen::Vector3d into;  ///< into the tissue there
    double within;         ///< [m] along, nearer than which two contacts would depend on one another
  };

  void collide_part(const MovingTool& moving, int tool, int part, std::span<const int> near);
  bool add_crossings(const MovingTool& moving, int tool, int part);
  bool add_crossing(const MovingTool& moving, int tool, int part);
  bool add_at(const Crossing& crossing, const MovingTool& moving, int tool, int part, double place);
  void add_vertices(const MovingTool& moving, int tool, int part, std::span<const int> near);
  void add_face(const MovingTool& moving, int tool, int part, std::span<const int> near);
  void add_faces(const MovingTool& moving, int tool, int part, std::span<const int> near);
  void keep_faces(const MovingTool& moving, int tool, int part, std::span<const int> near);
  void find_faces(const MovingTool& moving, int tool, int part, std::span<const int> near);
  const TouchContact* held_near(const MovingTool& moving, int tool, int part, double place, double within) const;
  bool place_taken(const MovingTool& moving, int tool, int part, const Place& place) const;
  bool triangle_taken(int tool, const std::array<int, 3>& nodes, int besides) const;
  void follow(int contact, const Eigen::Vector3d& centre, std::span<const int> near);
  void follow(int contact, const MovingTool& moving, std::span<const int> near);
  Eigen::Vector3d inward(const TouchContact& contact, bool segment) const;
  Eigen::Vector3d outward(int node) const;
  Eigen::Vector3d outward(const std::array<int, 3>& triangle) const;
  Eigen::Vector3d rest_outward(const TouchContact& contact) const;
  bool inside_out(const TouchContact& contact) const;
  Eigen::Vector3d came_from(int node, const Segment& before, const Eigen::Vector3d& into) const;
  bool pushed_through(int node, const TouchContact& by, double size) const;
  void aim(TouchContact& contact, const MovingTool& moving) const;
  void slide(TouchContact& contact, const MovingTool& moving) const;
  double margin(double radius) const;
  double radius(const MovingTool& moving, int part) const { return moving.radius(part) + options_.offset; }
  double reach(const MovingTool& moving, int part) const;
  double thrust(const MovingTool& moving, int part) const;
  Touching touch_of(const TouchContact& contact, const MovingTool& moving, const Segment& axis,
                    const Eigen::Vector3d& into) const;
  bool is_left_out(int tool, int part, int triangle) const {
    return options_.elsewhere && options_.elsewhere(tool, part, triangle);
  }
  double softness(int tool) const { return options_.softness.empty() ? 0.0 : options_.softness[tool]; }
  double face_softness(int tool, double radius) const {
    return softness(tool) + (options_.face_give ? options_.face_give(radius) : 0.0);
  }

  ContactLaw& law_;
  const ContactSurface& surface_;
  Options options_;
  double body_edge_;               ///< [m] mean edge of the surface at rest
  std::vector<double> mean_edge_;  ///< [m] per triangle, at rest
  std::vector<int> vertex_stamp_;
  int vertex_clock_ = 0;
  std::vector<int> near_;              ///< triangles near each part, part by part
  std::vector<std::size_t> near_end_;  ///< where each part's end in near_
  std::vector<int> own_near_;          ///< those of a part that it touches so
  std::vector<Candidate> candidates_;  ///< triangles that a segment may touch
  std::vector<Crossing> crossings_;    ///< of points along a segment
};

/// Marks the nodes of a surface that are near the tools or carry a contact, for the owner to work out where they are,
/// and returns them.
std::span<const int> mark(TouchSurface& surface, ToolContacts& contacts, const ContactLaw& law,
                          std::span<const MovingTool> tools);

/// Parts of all tools of a scene.
std::size_t parts_of(std::span<const Tool> tools);

/// [m] mean edge of a surface at rest.
double mean_edge(const SurfaceMap& map);

/// [m] of the cells in which a surface is looked for: as the scene says, or twice its mean edge.
double bucket_size(const ContactSpec& contact, const SurfaceMap& map);

}  // namespace palpate
