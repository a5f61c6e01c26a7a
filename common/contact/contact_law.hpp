#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/contact/held_points.hpp"

namespace palpate {

enum class Touch : std::uint8_t {
  open,      ///< near, no force
  sliding,   ///< the normal displacement is held, friction mu * normal force opposes the slip
  sticking,  ///< all three displacements are held
};

/// One contact: what presses, and the point of a body's surface that is pressed. It pushes and never pulls, unless jaws
/// hold it. Where another body's surface presses, `target`, `plane` and `position` are of the pressed point as seen
/// from the pressing one.
struct TouchContact {
  ContactSide by = ToolPoint{};
  bool face = false;     ///< anchored within a triangle; otherwise at the vertex anchor.nodes[0]
  bool grasped = false;  ///< held between jaws: sticks on all sides, pulls as well as pushes
  Touch touch = Touch::open;
  Anchor anchor;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, world, from the tool into the tissue
  Eigen::Vector3d slip = Eigen::Vector3d::Zero();     ///< unit or zero: direction of friction on the tissue
  Eigen::Vector3d force = Eigen::Vector3d::Zero();    ///< [N] on the tissue, world; conjugate to the anchor's motion
  /// [m/N] by which it gives way beyond what the nodes of its anchor do; of a patch.
  Eigen::Matrix3d give = Eigen::Matrix3d::Zero();
  // Of a tick that has many steps:
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();  ///< [N s] on the tissue
  Eigen::Vector3d pressed = Eigen::Vector3d::Zero();  ///< [N s] the part of it along each step's normal
  // Set before each solve:
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< [m] world: where a sticking anchor is held
  double plane = 0;                                  ///< [m] least value of normal . position of the anchor
  Eigen::Vector3d at = Eigen::Vector3d::Zero();      ///< [m] world: where the force acts on the tool
  // Set by solve:
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m] world: the deformed anchor

  // What presses, where that is a tool.
  const ToolPoint& tool_point() const { return std::get<ToolPoint>(by); }
  ToolPoint& tool_point() { return std::get<ToolPoint>(by); }
  bool is_by(int tool) const {
    const ToolPoint* point = std::get_if<ToolPoint>(&by);
    return point && point->tool == tool;
  }
  bool is_by(int tool, int part) const { return is_by(tool) && tool_point().part == part; }
  /// [m/N] by which the tool gives way; of another body its response says so.
  double softness() const {
    const ToolPoint* point = std::get_if<ToolPoint>(&by);
    return point ? point->softness : 0.0;
  }
  /// [m] where what presses, had it not given way, would hold the anchor now.
  Eigen::Vector3d held_at() const { return position + softness() * force; }
};

struct LawOutcome {
  int passes = 0;
  int raised = 0;         ///< pivots raised: contacts that nearly depend on one another were softened
  bool converged = true;  ///< false: the active set met its bound, and relaxation from there gave the forces
  bool finite = true;     ///< false: all forces were set to zero
};

/// A body as its contacts see it.
struct ContactBody {
  const Response& response;
  std::span<const Eigen::Vector3d> unloaded;  ///< [m] of its nodes without contact forces
};

/// Unilateral contact with Coulomb friction between one body and tools, or another body:
/// 0 <= normal force, gap >= 0, one of them zero; |tangential| <= mu * normal. The gap is that to the tool where its
/// force has pushed it back: (J C J^T + c I) f = gap. Solved by an active set that starts from the last step's and
/// changes in a fixed order, at most max_passes times; where that does not settle, a bounded relaxation goes on from
/// there.
class ContactLaw {
 public:
  static constexpr int kMaxPasses = 32;

  /// Each contact holds its anchor itself (barycentric rule, exact) or the triangle's three vertices by alpha_v
  /// (TVCG99 sec. 5 with the sign mended; stiffer).
  enum class Rule { barycentric, alpha };

  /// What the bodies name outlives this object. `by`: the one whose surface presses, if there is one.
  ContactLaw(const ContactBody& body, Rule rule, double friction, int capacity, std::optional<ContactBody> by = {});

  std::span<TouchContact> contacts() { return contacts_; }
  std::span<const TouchContact> contacts() const { return contacts_; }
  bool full() const;
  bool grasps(int tool) const;  ///< jaws of the tool hold one of the contacts
  int capacity() const { return static_cast<int>(contacts_.capacity()); }
  void add(const TouchContact& contact);
  /// Adds a contact together with the forces of its held points (3 or 9 numbers [N]), as point_forces() gave them.
  void add(const TouchContact& contact, std::span<const double> point_forces);
  std::span<const double> point_forces(int contact) const;
  void remove(int contact);
  void clear();
  /// Gives a contact another anchor; its force and state stay.
  void move_anchor(int contact, const Anchor& anchor);
  void forget_factor() { held_.forget_factor(); }
  void follow_response() { held_.follow_response(); }

  LawOutcome solve();

  /// Calls visit(contact, node, force on the tissue) for every node that carries force.
  template <class Visit>
  void for_each_nodal_force(Visit&& visit) const {
    for (std::size_t c = 0, p = 0; c < contacts_.size(); ++c)
      for (int k = 0; k < expansions_[c].points; ++k, ++p) {
        const Eigen::Vector3d f = Eigen::Map<const Eigen::Vector3d>(forces_.data() + 3 * p);
        const Anchor& a = held_.anchor(static_cast<int>(p));
        if (f.isZero(0)) continue;
        for (int v = 0; v < 3; ++v)
          if (a.weights[v] != 0) visit(static_cast<int>(c), a.nodes[v], Eigen::Vector3d(a.weights[v] * f));
      }
  }
  /// The same for the nodes of the body that presses, and the force on it.
  template <class Visit>
  void for_each_reaction(Visit&& visit) const {
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      const Anchor* a = std::get_if<Anchor>(&contacts_[c].by);
      for (int v = 0; a && v < 3; ++v)
        if (a->weights[v] != 0)
          visit(static_cast<int>(c), a->nodes[v], Eigen::Vector3d(-a->weights[v] * contacts_[c].force));
    }
  }

 private:
  /// The held points that stand for one contact.
  struct Expansion {
    int points = 1;
    std::array<double, 3> gain{1, 0, 0};   ///< displacement prescribed at the point / that of the anchor
    std::array<double, 3> share{1, 0, 0};  ///< anchor's displacement = sum share * point's
  };

  bool shares_vertex(const TouchContact& contact) const;
  static Expansion expand(const TouchContact& contact, int points, std::array<Anchor, 3>& anchors);
  void add_points(const TouchContact& contact, int points);
  int first_point(int contact) const;
  Eigen::Vector3d unloaded(const TouchContact& contact) const;
  int solve_held();
  Eigen::Vector3d displacement(int contact) const;
  void place(int contact);
  bool change_states(bool one_only, double min_force);
  bool change_state(int contact, double min_force);
  void relax();
  double relax_point(const TouchContact& contact, double gain, int point);

  ContactBody body_;
  std::optional<ContactBody> by_;
  Rule rule_;
  double friction_;
  HeldPoints held_;
  std::vector<TouchContact> contacts_;
  std::vector<Expansion> expansions_;
  std::vector<bool> restuck_;  ///< has gone from sliding to sticking in this step
  std::vector<Hold> hold_;
  std::vector<Eigen::Vector3d> normal_, displacement_target_;
  std::vector<double> forces_, displacements_;
  double worst_lag_ = 0;  ///< [N] largest change of a sliding contact's normal force since its friction was set
};

}  // namespace palpate
