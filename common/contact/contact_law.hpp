#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/contact/held_points.hpp"

namespace palpate {

enum class Touch : std::uint8_t {
  open,      ///< near, no force
  sliding,   ///< the normal displacement is held, friction mu * normal force opposes the slip
  sticking,  ///< all three displacements are held
};

/// One contact between a part of a tool and a point of the surface. It pushes and never pulls, unless jaws hold it.
struct TouchContact {
  int tool = 0;
  int part = 0;          ///< which part of the tool
  bool face = false;     ///< anchored within a triangle; otherwise at the vertex anchor.nodes[0]
  bool grasped = false;  ///< held between jaws: sticks on all sides, pulls as well as pushes
  Touch touch = Touch::open;
  double softness = 0;  ///< [m/N] by which what holds the anchor gives way to the force
  Anchor anchor;
  Eigen::Vector3d offset =
      Eigen::Vector3d::Zero();  ///< [m] touching point in the part's own frame; of what jaws hold, in the tip frame
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, world, from the tool into the tissue
  Eigen::Vector3d slip = Eigen::Vector3d::Zero();     ///< unit or zero: direction of friction on the tissue
  Eigen::Vector3d force = Eigen::Vector3d::Zero();    ///< [N] on the tissue, world; conjugate to the anchor's motion
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();  ///< [N s] on the tissue, of a tick that has many steps
  // Set before each solve:
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< [m] world: where a sticking anchor is held
  double plane = 0;                                  ///< [m] least value of normal . position of the anchor
  Eigen::Vector3d at = Eigen::Vector3d::Zero();      ///< [m] world: where the force acts on the tool
  // Set by solve:
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m] world: the deformed anchor

  /// [m] world: where the tool, had it not given way, would hold the anchor now.
  Eigen::Vector3d held_at() const { return position + softness * force; }
};

struct LawOutcome {
  int passes = 0;
  int raised = 0;         ///< pivots raised: contacts that nearly depend on one another were softened
  bool converged = true;  ///< false: the active set met its bound, and relaxation from there gave the forces
  bool finite = true;     ///< false: all forces were set to zero
};

/// Unilateral contact with Coulomb friction between tools and one body:
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

  /// `unloaded`: positions [m] of the body's nodes without contact forces; outlives this object, as `response` does.
  ContactLaw(const Response& response, std::span<const Eigen::Vector3d> unloaded, Rule rule, double friction,
             int capacity);

  std::span<TouchContact> contacts() { return contacts_; }
  std::span<const TouchContact> contacts() const { return contacts_; }
  bool full() const;
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
  int solve_held();
  Eigen::Vector3d displacement(int contact) const;
  void place(int contact);
  bool change_states(bool one_only, double min_force);
  bool change_state(int contact, double min_force);
  void relax();
  double relax_point(const TouchContact& contact, double gain, int point);

  std::span<const Eigen::Vector3d> unloaded_;
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
