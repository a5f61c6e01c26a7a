#pragma once
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "common/contact/patch/near_field.hpp"
#include "common/contact/patch/patch_memory.hpp"
#include "common/contact/patch/smooth_surface.hpp"
#include "common/describe/state.hpp"
#include "common/geometry/anchor.hpp"
#include "common/kernels/kernels.hpp"

namespace palpate {

/// The squares of a sphere's patch: their middles about the patch's own, and what the half-space makes of them. The
/// same for all patches of one radius on one material.
class PatchGrid {
 public:
  static constexpr int kMaxPoints = 64;

  PatchGrid(double radius, const HalfSpace& half_space);

  int size() const { return static_cast<int>(middle_.size()); }
  double radius() const { return radius_; }                                ///< [m] of the sphere
  double edge() const { return edge_; }                                    ///< [m] of a square
  const Eigen::Vector2d& middle(int p) const { return middle_[p]; }        ///< [m]
  double rise(int p) const { return rise_[p]; }                            ///< [m] of the sphere's middle over it there
  double pressed(int p, int q) const { return pressed_[size() * p + q]; }  ///< [m/N]
  const Eigen::Matrix2d& sheared(int p, int q) const { return sheared_[size() * p + q]; }  ///< [m/N]

 private:
  double radius_, edge_;
  std::vector<Eigen::Vector2d> middle_;
  std::vector<double> rise_, pressed_;
  std::vector<Eigen::Matrix2d> sheared_;
};

/// A force on a surface node [N].
struct PatchForce {
  int node = -1;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
};

/// The contact of one sphere with a body at rest under its loads: pressures on squares that go along with the sphere,
/// not with the mesh, and one shear over all of them that sticks or slips by Coulomb's law. The tissue gives way by
///   A = G + Phi K Phi^T,
/// G being the half-space's kernel between the squares, Phi the hats of the surface's nodes at them and K what the
/// body's compliance has beyond the half-space's (NearField). All is measured at the body's rest shape, as linear
/// elasticity does. On tissue that relaxes A is softer by what it creeps within a step, and the past has moved the
/// ground.
class Patch {
 public:
  static constexpr int kMaxNodes = 64;  ///< near nodes that a patch may rest on

  /// `creep`: of tissue that relaxes; G and K are softer by its instant() then.
  explicit Patch(const PatchGrid& grid, const std::optional<CreepStep>& creep = {});

  /// What the patch looks at; all outlive the patch.
  struct Ground {
    const SmoothSurface& surface;
    const NearField& near_field;
    double friction;
  };
  /// The nodes that lie under the sphere now, found by where it stands; empty: it does not touch, and forgets its
  /// shear.
  std::span<const int> lay(const Ground& ground, const Eigen::Isometry3d& before, const Eigen::Isometry3d& now,
                           const Eigen::Vector3d& middle);
  /// Solves for the pressures and the shear. `moved` [m]: displacement of those nodes by all other forces and by all of
  /// the past.
  void press(const Ground& ground, std::span<const Eigen::Vector3d> moved);
  /// Ends a step on tissue that relaxes. `moved` [m]: displacement of those nodes by forces() alone.
  void remember(std::span<const Eigen::Vector3d> moved);
  void lift();  ///< no contact any more
  /// Goes on from a force [N] on the tissue that the same patch had in an earlier life.
  void resume(const Eigen::Vector3d& force) { resumed_ = force; }

  bool touches() const { return pressing_ > 0; }
  double pressing() const { return pressing_; }              ///< [N]
  const Eigen::Vector3d& force() const { return force_; }    ///< [N] on the tissue
  const Eigen::Vector3d& at() const { return at_; }          ///< [m] world: where it acts on the tool
  const Eigen::Vector3d& normal() const { return normal_; }  ///< unit, into the tissue
  const Anchor& anchor() const { return anchor_; }           ///< of the surface, at its middle
  bool sticks() const { return sticks_; }
  /// On the nodes under it.
  std::span<const PatchForce> forces() const { return std::span(forces_).first(loaded_); }

  void state(State& s);
  bool fits(int nodes) const;  ///< whether what was restored can be of a surface of so many nodes

 private:
  struct Foot {
    std::array<int, 3> local{-1, -1, -1};  ///< of nodes_
    Eigen::Vector3d weights;
    double gap = 0;  ///< [m] by which the sphere reaches below the rest surface here
  };

  int local(int node);
  bool find_below(const Ground& ground, const Eigen::Vector3d& middle);
  void turn_to(const Eigen::Isometry3d& before, const Eigen::Isometry3d& now, const Eigen::Vector3d& middle);
  void lay_feet(const Ground& ground, const Eigen::Vector3d& middle);
  void fill_near_field(const NearField& near_field);
  void fill_normal();
  void settle_pressures();
  bool solve_active();
  void shear(const Ground& ground);
  void add_slip(const Eigen::Vector3d& bent_before);

  const PatchGrid& grid_;
  Eigen::Vector3d normal_, across_, up_, at_, force_, travel_;
  Anchor anchor_;
  Eigen::Vector3d bent_ = Eigen::Vector3d::Zero();     ///< [m] the tissue's shear under the patch
  Eigen::Vector3d resumed_ = Eigen::Vector3d::Zero();  ///< [N] not zero: the shear is to begin with its part
  Eigen::Vector2d slip_ = Eigen::Vector2d::Zero();     ///< [m] of the tip over the tissue, within the step
  Eigen::Vector3d sheared_ = Eigen::Vector3d::Zero();  ///< [m] that the step's own shear bends the tissue
  std::optional<PatchMemory> memory_;
  bool sticks_ = true;
  double pressing_ = 0, depth_ = 0;
  std::span<const int> near_;  ///< triangles, of lay() alone
  std::vector<Foot> feet_;     ///< per square
  std::vector<int> nodes_;     ///< under the patch
  std::vector<unsigned char> active_;
  std::vector<double> wanted_, pressure_force_, compliance_, factor_, right_, floor_;
  std::vector<int> rows_;
  std::vector<int> known_;                   ///< nodes that near_field_ is of
  std::vector<Eigen::Matrix3d> near_field_;  ///< K between nodes_, kMaxNodes a row
  std::vector<double> k_, k_phi_;
  std::array<PatchForce, kMaxNodes> forces_;
  int loaded_ = 0;  ///< how many of them
};

}  // namespace palpate
