#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "common/contact/cut_surface.hpp"
#include "common/dynamics/dynamic_model.hpp"
#include "common/dynamics/elastic_mesh.hpp"
#include "common/geometry/anchor.hpp"
#include "common/mesh/shown_surface.hpp"
#include "common/tool/moving_tool.hpp"

namespace palpate {

/// One contact between a tool and a point of moving tissue. Plain memory: keyframes copy it.
struct TissueContact {
  static constexpr std::int32_t kInJaws = -1;

  std::int32_t tool = 0;
  std::int32_t sample = 0;  ///< which part of the tool, or in_jaws: held on all sides until the jaws open
  std::int32_t face = 0;    ///< 1: anchored within a facet; 0: at the node anchor.nodes[0]
  std::int32_t sticking = 1;
  Anchor anchor;
  Eigen::Vector3d offset =
      Eigen::Vector3d::Zero();  ///< [m] where the anchor sticks to the tool: the part's frame, in jaws the tip's
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, world, from the tool into the tissue
  Eigen::Vector3d force = Eigen::Vector3d::Zero();    ///< [N] on the tissue: a load within each step
  Eigen::Vector3d push = Eigen::Vector3d::Zero();  ///< [kg m] force times the step squared, while a step is put right
};

/// Contacts of tools with a dynamic body. Their forces are loads within each step; after it the touched points are put
/// onto the tools' parts (never pulled towards them), and what the jaws hold is put where the jaws are, by a projection
/// along M^-1. What that took goes into the forces, so that at rest they are those of the static problem and nothing is
/// left to put right. No stiffness of contact limits the step.
class TissueContacts {
 public:
  static constexpr int kMost = 32;

  TissueContacts(const ElasticMesh& mesh, const CutMesh& topology, const ShownSurface& shown, const CutSurface& surface,
                 DynamicModel& model, double friction);

  std::span<const TissueContact> list() const { return contacts_; }

  /// Once a tick: which points the tools' parts touch. Contacts that go on keep where they stick.
  void find(std::span<const MovingTool> tools);
  /// Forgets what a tool touches, its jaws' hold as well.
  void drop_tool(int tool);
  /// Takes points into a tool's jaws; true if there was something between them (see between_jaws()).
  bool grasp(int tool, const Eigen::Isometry3d& pose, double length, double width);
  void let_go(int tool);
  bool grasping(int tool) const;

  /// One step of `dt` [s] of the tissue under the contacts' forces, and what they have to put right after it. `poses`:
  /// the tools' at its beginning and end.
  void step(std::span<const MovingTool> tools, std::span<const Eigen::Isometry3d> begin,
            std::span<const Eigen::Isometry3d> end, double dt);
  /// After the last step of a tick: sliding points let their anchors follow.
  void end_tick(std::span<const MovingTool> tools);
  /// After a cut: contacts on what is gone are dropped.
  void forget_removed();

  /// State for keyframes.
  void set_list(std::span<const TissueContact> contacts);

 private:
  Eigen::Vector3d position(const Anchor& anchor) const;
  Eigen::Vector3d inverse_mass(int node) const;
  bool anchored(const TissueContact& c) const;
  void find_part(std::span<const MovingTool> tools, int tool, int sample);
  bool add_crossing(const MovingTool& tool, int index, int sample);
  void add_nodes(const MovingTool& tool, int index, int sample, std::span<const int> near);
  void add_face(const MovingTool& tool, int index, int sample, std::span<const int> near);
  void add(const TissueContact& contact, const MovingTool& tool);
  Eigen::Vector3d velocity(const Anchor& anchor) const;
  Eigen::Vector3d mobility(const Anchor& anchor) const;
  void load_tissue();
  static Eigen::Vector3d held_at(const TissueContact& contact, const MovingTool& tool, const Eigen::Isometry3d& pose);
  void put_right(TissueContact& contact, const MovingTool& tool, const Eigen::Isometry3d& pose);
  void follow_tool(const TissueContact& contact, const MovingTool& tool, const Eigen::Isometry3d& begin,
                   const Eigen::Isometry3d& end, double dt);
  void move(const Anchor& anchor, const Eigen::Vector3d& push, const Eigen::Vector3d& impulse);

  const ElasticMesh& mesh_;
  const CutMesh& topology_;
  const ShownSurface& shown_;
  const CutSurface& surface_;
  DynamicModel& model_;
  double friction_;
  std::vector<TissueContact> contacts_, before_;
  std::vector<std::pair<int, Eigen::Vector3d>> other_load_;  ///< [N] of others, per node that contacts load in a step
};

}  // namespace palpate
