#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "common/contact/patch/near_field.hpp"
#include "common/contact/patch/node_blocks.hpp"
#include "common/contact/patch/patch_grid.hpp"
#include "common/contact/patch/patch_memory.hpp"
#include "common/contact/patch/smooth_surface.hpp"
#include "common/describe/state.hpp"
#include "common/geometry/anchor.hpp"
#include "common/kernels/kernels.hpp"

namespace palpate {

/// A force on a surface node [N].
struct PatchForce {
  int node = -1;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
};

/// [m/N] By which a node of a patch gives way within a step under a force on another one, or on itself. The transpose
/// goes the other way.
struct NodeGive {
  int i, j;  ///< places among the nodes of Patch::lay()
  Eigen::Matrix3d block;
};

/// A straight line within a triangle: its two ends, as a patch sees them, and their weights.
struct TriangleCut {
  std::array<Eigen::Vector3d, 2> end, weights;
};

/// The contact of one sphere, or of a segment's flank, with a body at rest under its loads: pressures on cells that go
/// along with it, not with the mesh, and one shear over all of them that sticks or slips by Coulomb's law. The tissue
/// gives way by
///   A = G + Phi K Phi^T,
/// G being the half-space's kernel between the cells, Phi the hats of the surface's nodes at their feet and K what the
/// body's compliance has beyond the half-space's (NearField). All is measured at the body's rest shape, as linear
/// elasticity does. On tissue that relaxes A is softer by what it creeps within a step, and the past has moved the
/// ground; segments do not know of that.
///
/// The cells under a segment cover the piece of it that lies in the tissue's rest shape, by how far it does: their
/// length, their place and their common normal follow the tool's pose without a jump.
class Patch {
 public:
  static constexpr int kMaxCells = 80;             ///< of any grid
  static constexpr int kMaxNodes = 3 * kMaxCells;  ///< that any patch may rest on

  /// [m/s] At which tissue that is found deep within a tool is led out of it.
  static constexpr double kWayOut = 0.02;

  /// `creep`: of tissue that relaxes; G and K are softer by its instant() then.
  explicit Patch(const PatchGrid& grid, const std::optional<CreepStep>& creep = {});
  int max_nodes() const { return max_nodes_; }  ///< that it may rest on: three corners below each foot

  /// What the patch looks at; all outlive the patch.
  struct Ground {
    const SmoothSurface& surface;
    const NearField& near_field;
    double friction;
  };
  /// One step of tissue that moves, as the patch meets it. Of `moved` and `went`, one entry for each node of lay().
  struct Step {
    Eigen::Isometry3d before, now;           ///< of the tool
    Segment axis;                            ///< [m] of the part, now; of a sphere a point
    std::span<const Eigen::Vector3d> moved;  ///< [m] from rest to the step's end, by all but this patch
    std::span<const Eigen::Vector3d> went;   ///< [m] of that within the step
    std::span<const NodeGive> give;          ///< each pair of nodes once; those left out do not move one another
  };
  /// The nodes that lie under the part now, found by where its axis lies, of a sphere a point; empty: it does not
  /// touch, and forgets its shear. `above` [m]: how far above the rest surface it may be, where that may come towards
  /// it.
  std::span<const int> lay(const Ground& ground, const Eigen::Isometry3d& before, const Eigen::Isometry3d& now,
                           const Segment& axis, double above = 0);
  /// After lay(): another patch's last forces lie on this tissue too. What they do to the cells by the half-space; what
  /// they do beyond it comes with `moved`.
  void lie_beside(const Patch& other);
  /// The same in two steps: [m] the dents at its cells, and all such in which it lies now.
  using OfCells = std::array<double, kMaxCells>;
  void find_dents(const Patch& other, OfCells& dents);
  void lie_in(const OfCells& dents);
  /// [m] By which it sinks in such dents and as the nodes of lay() are moved, in the mean over its last pressures;
  /// where it has none, where it is deepest.
  double sunk(const OfCells& dents, std::span<const Eigen::Vector3d> moved) const;
  /// [m/N] By which the tissue gives way under the same, along the normal, beyond what its nodes do.
  double softness() const;
  /// Solves for the pressures and the shear. `moved` [m]: displacement of those nodes by all other forces and by all of
  /// the past. `less` [m]: by which the part presses less deep than it stands.
  void press(const Ground& ground, std::span<const Eigen::Vector3d> moved, double less = 0);
  /// Begins a tick of tissue that moves, after lay() for the tool as it is at the tick's end: what the
  /// nodes do under forces comes from its steps, and K is what the body's compliance has beyond both the half-space's
  /// and the nodes' own. `give`: as in Step; the same in all steps of the tick.
  void meet(const Ground& ground, std::span<const NodeGive> give);
  /// A step within that tick, first half: [m] by how much the part reaches below the surface at each cell without
  /// this patch's forces; -infinity where it lies beside it. What the caller takes off is not put right yet.
  std::span<double> sink(const Ground& ground, const Step& step);
  /// Second half: solves for the pressures and the shear at its end.
  void step(const Ground& ground, const Step& step);
  /// Ends a step on tissue that relaxes. `moved` [m]: displacement of those nodes by forces() alone.
  void remember(std::span<const Eigen::Vector3d> moved);
  void lift();  ///< no contact any more
  /// What was worked out in earlier ticks, and holds for longer, is worked out anew.
  void forget_factor() { known_.clear(); }
  /// Goes on from a force [N] on the tissue that the same patch had in an earlier life.
  void resume(const Eigen::Vector3d& force) { resumed_ = force; }

  /// After lay(): the share of the last step's pressures whose cells have left the tissue, over a rim.
  double lost() const { return lost_; }

  /// Whether the last pressures are the solution; else they are the last of a bounded number of tries.
  bool settled() const { return settled_; }

  bool touches() const { return pressing_ > 0; }
  double depth() const { return depth_; }        ///< [m] after lay(): the largest, at least 0
  double pressing() const { return pressing_; }  ///< [N] along the normal
  /// [N] On the tissue, without shear.
  Eigen::Vector3d pressure() const { return pressing_ * push_; }
  const Eigen::Vector3d& force() const { return force_; }    ///< [N] on the tissue
  const Eigen::Vector3d& at() const { return at_; }          ///< [m] world: where it acts on the tool
  const Eigen::Vector3d& normal() const { return normal_; }  ///< unit, into the tissue
  const Anchor& anchor() const { return anchor_; }           ///< of the surface, at the middle of what it has passed
  /// [m/N] By how much the tissue gives way under the patch as it is pressed and sheared now, beyond what its nodes do.
  Eigen::Matrix3d give() const;
  bool sticks() const { return sticks_; }
  /// On the nodes under it.
  std::span<const PatchForce> forces() const { return std::span(forces_).first(loaded_); }

  void state(State& s);
  bool fits(int nodes) const;  ///< whether what was restored can be of a surface of so many nodes

 private:
  static constexpr int kTurns = 6;        ///< at most, of the normal towards that of what lies below
  static constexpr double kFacing = 0.2;  ///< cosine between a facet's normal and the patch's: below it, it lies aside
  static constexpr double kMinCover = 1e-3;  ///< of a cell, below which it is not there

  struct Foot {
    int triangle = -1;           ///< that it stands on; -1: none
    std::array<int, 3> local{};  ///< of nodes_, its corners
    Eigen::Vector3d weights;
    /// [m] Along the normal, of the rest surface below the patch's origin; infinite where there is none.
    double depth = 0;
    bool stands() const { return triangle >= 0; }
  };
  struct Cell {
    double gap = 0;    ///< [m] by which the part reaches below the rest surface here; -infinity where there is none
    double cover = 1;  ///< share of it below which there is tissue
    Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< [m] of the rest surface
    double dent = 0;                               ///< [m] by other patches
  };
  /// How a segment lies over the tissue: its axis above the patch's first axis.
  struct Flank {
    double slope = 0, steep = 1;  ///< along the normal per length, and the axis' own length per length
    double from = 0, to = 0;      ///< [m] its straight part
  };
  /// The piece of it that lies in the rest shape, by its moments.
  struct Overlap {
    double sum = 0, first = 0, second = 0;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  };

  /// What a step's forces are to bend, and what that takes.
  struct Drag {
    Eigen::Vector3d travel;                 ///< [m] of the tool over the step
    std::span<const Eigen::Vector3d> went;  ///< empty: the nodes stay where they are but for the patch's forces
    std::span<const NodeGive> give;
  };

  int local(int node);
  const Foot& foot(int cell) const { return feet_[grid_.foot(cell)]; }
  bool laid(int cell) const { return std::isfinite(cells_[cell].gap); }
  /// Into the tissue, 1 along the normal: how a pressure at a foot pushes, and along which it is met.
  Eigen::Vector3d direction(int foot) const;
  /// [m] By which the tissue at a foot is out of the way of what presses there, its nodes being moved, and by shear.
  double rise(int foot, std::span<const Eigen::Vector3d> moved) const;
  double gap(int cell, const Step& step) const;
  Eigen::Vector3d on_axis(const Segment& axis, double along) const;
  double middle_of_pressure() const;
  void find_shares(OfCells& shares) const;
  /// Triangles in which the sphere or strip may have feet.
  std::span<int> near(const SmoothSurface& surface, const Segment& axis) const;
  bool find_below(const Ground& ground, const Eigen::Vector3d& middle, double above);
  bool find_along(const Ground& ground, const Segment& axis);
  bool find_nearest(const Ground& ground, const Segment& axis);
  bool turn_along(const Segment& axis);
  Overlap overlap(const Ground& ground) const;
  void add_overlap(const Ground& ground, int triangle, double under, TriangleCut cut, Overlap& all) const;
  void lay_window(const Overlap& overlap);
  void lay_anchor(const Ground& ground);
  void lay_strip(const Ground& ground);
  void keep_below(const Ground& ground);
  void lay_row(int row, const std::array<Eigen::Vector3d, 3>& triangle);
  void lay_middles();
  bool lay_rims(const Ground& ground);
  int find_parted(const Ground& ground, std::array<int, kMaxCells>& parted) const;
  bool may_lie_below(const Ground& ground, int triangle, double more) const;
  std::array<Eigen::Vector3d, 3> seen_in_plane(const Ground& ground, int triangle) const;
  void lay_squares(const Ground& ground);
  void stand_on_nearest(const Ground& ground, int foot);
  void lay_feet(const Ground& ground, double aside = 0);
  void stand_on(const SurfaceMap& map, Foot& foot);
  void stand_on_triangles(const SurfaceMap& map);
  double facing(const Ground& ground, int triangle) const;
  bool presses(const Ground& ground, int triangle) const;
  Eigen::Vector3d in_plane(const Eigen::Vector3d& p) const;
  Eigen::Vector2d foot_middle(int foot) const;
  double cell_middle(int column) const { return window_ + (column + 0.5) * cell_length_; }
  Eigen::Vector3d place_of_force() const;
  void fill_near_field(const NearField& near_field);
  void fill_normal();
  void fill_feet(const NodeBlocks& nodes, std::span<const int> place, int places);
  void fill_cell(int q);
  void keep_positive();
  bool is_positive();
  void list_laid();
  void raise_eigenvalues();
  void add_nodes_give(std::span<const NodeGive> give);
  void settle_pressures();
  bool solve_active();
  void lift_cells(const Ground& ground, std::span<const NodeGive> give);
  void lift_nodes(std::span<const NodeGive> give);
  void bound_lift();
  double lift_at(const Foot& foot) const;
  void sum_pressures();
  double share_leaning() const;
  double give_aside() const;
  Eigen::Matrix3d shared_near_field(std::span<const double> share) const;
  Eigen::Matrix2d compliance_to_shear(const Eigen::Matrix<double, 3, 2>& plane, std::span<const double> share) const;
  void shear(const Ground& ground, const Drag& drag);
  void add_slip(const Eigen::Vector3d& bent_before);

  const PatchGrid& grid_;
  const int max_nodes_;
  Eigen::Vector3d normal_, across_, up_, at_, force_, travel_;
  Eigen::Vector3d laid_at_ = Eigen::Vector3d::Zero();       ///< [m] the sphere's middle, the segment's start, at lay()
  Eigen::Isometry3d back_ = Eigen::Isometry3d::Identity();  ///< the tool's motion within the step, backwards
  Anchor anchor_;
  Eigen::Vector3d bent_ = Eigen::Vector3d::Zero();     ///< [m] the tissue's shear under the patch
  Eigen::Vector3d resumed_ = Eigen::Vector3d::Zero();  ///< [N] not zero: the shear is to begin with its part
  Eigen::Vector2d slip_ = Eigen::Vector2d::Zero();     ///< [m] of the tip over the tissue, within the step
  Eigen::Vector3d shear_ = Eigen::Vector3d::Zero();    ///< [N] on the tissue
  Eigen::Vector3d sheared_ = Eigen::Vector3d::Zero();  ///< [m] that the step's own shear bends the tissue
  std::optional<PatchMemory> memory_;
  bool sticks_ = true;
  Eigen::Matrix2d sheared_give_ = Eigen::Matrix2d::Zero();  ///< [m/N] along across_ and up_
  NodeBlocks nodes_give_;                                   ///< within a step, between nodes_
  std::vector<double> lifted_, lift_;  ///< [m] along the normal by shear, per node of nodes_ and per cell
  bool settled_ = true;
  double pressing_ = 0, depth_ = 0;
  double leans_ = 0;                                 ///< [1] share of the ball's own lean by which pressures lean
  double aside_ = 0;                                 ///< [m/N] by which a sphere gives way sideways
  Eigen::Vector3d push_ = Eigen::Vector3d::UnitZ();  ///< along which they push in all, 1 along the normal
  double lost_ = 0;
  std::span<int> near_;  ///< triangles, of lay() alone
  PatchKernel kernel_;
  Flank flank_;
  double window_ = 0, cell_length_ = 0;       ///< [m] along the first axis: where the columns begin, and a column's
  double passed_ = 0;                         ///< [m] likewise: the middle of what a segment has passed
  double above_ = 0;                          ///< [m] of lay()
  std::vector<Cell> cells_;                   ///< per cell of the grid
  std::vector<Foot> feet_;                    ///< per foot of the grid
  std::vector<Eigen::Vector2d> foot_middle_;  ///< [m] about the patch's middle, likewise: of what lies over tissue
  std::vector<int> nodes_;                    ///< under the patch
  std::vector<unsigned char> active_;
  std::vector<double> wanted_, pressure_force_, compliance_, factor_, right_, floor_;
  std::vector<int> rows_;
  NodeBlocks near_field_;                            ///< K between nodes_, each at a place of its own
  std::vector<int> known_, place_;                   ///< the node at each place, -1: none; the place of each of nodes_
  std::array<double, kMaxNodes> at_places_;          ///< [m] along the normal, per place, of a shear
  std::array<std::vector<double>, 3> moved_places_;  ///< [m/N] likewise, by coordinate, of a force on one foot
  std::vector<Eigen::Vector3d> direction_;           ///< per foot, of what presses there (direction())
  std::vector<PatchForce> forces_;
  int loaded_ = 0;              ///< how many of them
  std::vector<double> k_feet_;  ///< [m/N] between feet, of K or of what the nodes do in a step
};

}  // namespace palpate
