#pragma once
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/contact/contact_law.hpp"
#include "common/contact/cut_surface.hpp"
#include "common/contact/patch/patch.hpp"
#include "common/contact/step_settings.hpp"
#include "common/dynamics/elastic_mesh.hpp"
#include "common/models/moving/condensed_touch.hpp"
#include "common/models/moving/inertial_response.hpp"
#include "common/models/moving/neighbour_patches.hpp"
#include "common/models/moving/tissue_nodes.hpp"
#include "common/tool/moving_tool.hpp"

namespace palpate {

/// The patches of tools' tips and shafts on moving tissue. Once a tick each is laid on the tissue's rest shape, seen
/// from the rigid motion that the tissue has made there; in each step of the tissue its pressures and its shear are
/// solved for the step's end, where
///   (L + Phi D Phi^T) p = gap of the step without them,   p >= 0, one of them an equality,
///   L = G + Phi (K - C) Phi^T,
/// K being what the tissue has at rest beyond the half-space G (NearField), C its nodes' own compliance, and D how
/// these give way within the step (TissueNodes): at rest that is the answer of the patch on tissue without inertia. A
/// patch lies on both parts of a hybrid alike, and in the dents that others make (NeighbourPatches). What has been cut
/// open, and jaws, are left to contacts by points.
class TissuePatches {
 public:
  /// `archive`: read with ArchivePart::surface; it and `settings` are looked at here alone. `still`: of a hybrid body,
  /// null for others. All else outlives this object.
  TissuePatches(const Archive& archive, const ElasticMesh& mesh, const CutMesh& topology, const CutSurface& surface,
                DynamicModel& model, CondensedTouch* still, const InertialResponse& response,
                const StepSettings& settings);

  /// What presses no more though it was not lifted: what it did to nodes is added to `forces`, and `leave` is told of a
  /// contact that was its own.
  struct Loose {
    std::vector<PatchForce>& forces;
    std::function<void(const TouchContact&)> leave;
  };
  /// Once a tick: lays the patches of what is near; none of a tool that grasps the tissue. Cells that have gone over a
  /// rim come loose.
  void find(std::span<const MovingTool> tools, const std::function<bool(int tool)>& grasps, const Loose& loose);
  /// Whether one is laid.
  bool laid() const;
  bool laid(int tool) const;      ///< one of this tool
  bool leads_in(int tool) const;  ///< one that stands too deep as yet
  /// Whether a part of a tool has one.
  bool has(int tool, int part) const;
  /// Whether a facet of the CutMesh is theirs.
  bool covers(int facet) const { return triangle_of_facet_[facet] >= 0; }
  /// [m/N] By which tissue gives way, beyond what its nodes do, where a part of a radius [m] has none and rests on a
  /// point of a triangle: as under one square as wide as the part.
  double give_of_point(double radius) const;
  /// After a step of `dt` [s] of the tissue without them: their forces put it right. `tools`: as they are at its
  /// beginning and end.
  void step(std::span<const MovingTool> tools, double dt);
  /// After the last step of a tick of `dt` [s].
  void end_tick(std::span<const MovingTool> tools, double dt);

  /// Visits the patches that touched in the last tick as one contact each.
  void add_contacts(std::vector<TouchContact>& contacts) const;

  void forget_factor();
  /// Steps are of another length from now on.
  void follow_response();
  void drop_tool(int tool);
  /// After a cut. A patch that has lost tissue under it comes loose, and is laid anew.
  void follow_cut(const CutMesh& topology, const Loose& loose);
  void state(State& s);

 private:
  using OfCells = Patch::OfCells;

  struct Part {
    int tool, part;
    Patch patch;
    double radius;                                             ///< [m]
    double above;                                              ///< [m] from which it is laid
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();  ///< of the tissue from rest
    std::vector<int> nodes;                                    ///< under it; empty: it is not laid
    std::vector<int> known;                                    ///< those that `world_give` is of
    std::vector<NodeGive> world_give, give;                    ///< as they are, and seen from rest
    std::vector<Eigen::Vector3d> last;                         ///< [m] their displacements after its last forces
    OfCells ease{};                                            ///< [m] that it stands too deep, and is led out of
    OfCells depth{};                                           ///< [m] in the last step
    bool relaid = false;                                       ///< no step has been done since it was laid
    bool cut = false;                                          ///< what it lay on has gone
    double approach = 0;                                       ///< [m] its way in this tick
    Eigen::Vector3d impulse = Eigen::Vector3d::Zero();         ///< [N s] of the tick, on the tissue
    TouchContact contact;                                      ///< of the last tick
  };

  /// A surface that tools meet, and of its triangles those of map_.
  struct Ground {
    const ContactSurface& surface;
    std::vector<int> triangle;  ///< per triangle of it; -1: none
  };

  bool has_gone(int triangle, const CutMesh& topology) const;
  bool loses(const Part& own, const CutMesh& topology) const;
  void leave_out(const CutMesh& topology);
  bool find_place(const Part& own, const MovingTool& tool, Eigen::Vector3d& place) const;
  Eigen::Isometry3d motion_about(const Eigen::Vector3d& place, double within);
  void find_give(Part& own);
  void lay(Part& own, const MovingTool& tool, const Loose& loose);
  static void come_loose(const Part& own, double share, std::span<const PatchForce> forces, const Loose& loose);
  void lift(Part& own);
  void let_go(Part& own, const Loose& loose);
  void ease_in(Part& own, std::span<const double> depth) const;
  void press(Part& own, const MovingTool& tool, double dt);
  std::span<const PatchForce> seen_from_world(const Part& own);
  int number(const Part& own) const { return static_cast<int>(&own - parts_.data()); }

  const ElasticMesh& mesh_;
  double friction_;
  SurfaceMap map_;
  SmoothSurface surface_;
  double longest_edge_;                 ///< [m]
  std::vector<int> triangle_of_facet_;  ///< of map_, per facet of the CutMesh; -1: none
  std::vector<int> facet_of_triangle_;  ///< -1: nothing cuts it
  std::vector<Ground> grounds_;
  std::unique_ptr<TissueNodes> nodes_;
  std::unique_ptr<NearField> near_field_;
  HalfSpace material_;
  PatchGrids grids_;
  std::vector<Part> parts_;
  NeighbourPatches neighbours_;
  std::vector<Eigen::Vector3d> moved_, went_;
  std::vector<PatchForce> forces_;
  std::vector<int> ground_of_node_;        ///< per node: the one that knows where it is
  std::vector<Eigen::Vector3d> position_;  ///< [m] per node, of those near a tip
};

}  // namespace palpate
