#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/contact/step_settings.hpp"
#include "common/describe/state.hpp"
#include "common/dynamics/dynamic_model.hpp"
#include "common/dynamics/elastic_mesh.hpp"
#include "common/dynamics/make_model.hpp"
#include "common/dynamics/spec.hpp"
#include "common/models/moving/condensed_touch.hpp"
#include "common/models/moving/cuttable_tissue.hpp"
#include "common/models/moving/passing_tools.hpp"
#include "common/models/moving/tissue_touch.hpp"
#include "common/models/moving/tool_in_tick.hpp"

namespace palpate {

/// One dynamic body in the deformation node: its tissue and what tools do to it: touch, hold, cut. One tick at a
/// time; the same inputs from the same state give the same bits.
class DynamicOrgan {
 public:
  /// Throws std::runtime_error naming the body if the scene's step is not stable, with the bound.
  DynamicOrgan(const Archive& archive, const MovingSpec& body, const StepSettings& settings, const MakeModel& make);
  ~DynamicOrgan();

  /// Moves the tissue on by `dt` [s] while the tools go from their poses before to now, then cuts and tears. Where a
  /// tool has been put into it, its motion is stopped for a while as in settle().
  void tick(std::span<const ToolInTick> tools, double dt);
  /// The same without a cut, and with all motion stopped once it has begun to slow down: one after another lead to
  /// rest, as each stop finds the tissue where it moves fastest, which is near its rest (P. A. Cundall's dynamic
  /// relaxation by kinetic damping).
  void settle(std::span<const ToolInTick> tools, double dt);

  /// Before the first tick: these tetrahedra have gone before, and `changes` is what they are. False, and nothing has
  /// happened, if one of them is not of this body.
  bool begin_without(std::span<const std::uint32_t> removed);

  /// Which of the tools that begin pass through the tissue as it is, as after a tick that they begin in.
  void meet(std::span<const ToolInTick> tools);
  /// Whether a tool and the tissue pass through one another (PassingTools). What glows cuts all the same.
  bool passes(int tool) const { return passing_.passes(tool); }

  /// Factors are made anew: at each keyframe, so that a replay from there gives the same bits.
  void forget_factors() {
    contacts_.forget_factor();
    if (still_) still_->forget_factor();
  }

  double max_step() const { return max_step_; }  ///< [s] that the bound allows, or the scene gives
  /// Steps of the tissue in a tick of dt [s]: of the scene's integrator, or while tools touch it of the semi-implicit
  /// one.
  int steps_in(double dt, bool touched = false) const;
  const CutMesh& topology() const { return tissue_.topology(); }
  const CutSurface& surface() const { return tissue_.surface(); }
  const DynamicModel& model() const { return *model_; }
  const ElasticMesh& mesh() const { return mesh_; }
  std::span<const TouchContact> contacts() const { return contacts_.contacts(); }
  /// The quasi-static part of a hybrid organ; null for others.
  const CondensedTouch* condensed_part() const { return still_.get(); }
  /// [m] of a surface node of either part.
  Eigen::Vector3d position(int node) const;
  Eigen::Vector3d displacement(int node) const;  ///< [m] of a node of either part
  /// Nodes by which moving tissue hangs on the quasi-static part.
  bool is_joined(int node) const { return tissue_.is_joined(node); }
  bool holds(int tool) const;  ///< its jaws hold something of this organ

  using Change = CuttableTissue::Change;
  /// What the last tick took away; empty most of the time.
  std::span<const Change> changes() const { return tissue_.changes(); }
  const std::vector<int>& removed() const { return tissue_.removed(); }  ///< all so far, in order

  /// [m] World, near the body: where shape() counts from.
  const Eigen::Vector3d& origin() const { return origin_; }
  /// Position [m] from the origin on and unit normal per node of the archive's surface map; nodes off the surface have
  /// no normal.
  void shape(std::vector<Eigen::Vector3f>& position, std::vector<Eigen::Vector3f>& normal);

  /// For keyframes and hashes. `tools`: as they are, where it restores; throws std::runtime_error on a state of another
  /// body, and is of no use after it.
  void state(State& s, std::span<const MovingTool> tools);

 private:
  /// What a tool can do to it, and whether its jaws are shut. It takes hold by one of the two at most.
  struct Hand {
    std::optional<ClosingJaws> closing;
    std::optional<ForcepsShape> turning;
    std::optional<Cautery> cautery;
    bool holding = false;
    bool began = false;  ///< over the tissue, and has not pressed it yet
  };
  void advance(std::span<const ToolInTick> tools, double dt);
  void calm();
  bool put_into(bool swings);
  void take_tools(std::span<const ToolInTick> tools);
  void move_tools(double share);
  void work_jaws(std::span<const ToolInTick> tools);
  void let_pass(std::span<const ToolInTick> tools);
  bool glows(int tool, const ToolInTick& with) const;
  void grasp(int tool, const ToolInTick& with);
  void update_positions();
  void cut(std::span<const ToolInTick> tools);
  void tear_and_drop();
  void let_go_of_gone();

  std::vector<Hand> hands_;  ///< per tool
  ElasticMesh mesh_;
  std::unique_ptr<DynamicModel> model_;
  std::unique_ptr<CondensedTouch> still_;
  CuttableTissue tissue_;
  TissueTouch contacts_;
  PassingTools passing_;
  double max_step_, touched_step_;
  Eigen::Vector3d origin_;
  std::vector<Eigen::Vector3d> position_;      ///< [m] per node
  std::vector<MovingTool> in_tick_, in_step_;  ///< per tool: from before to now in the tick, and in one of its steps
  std::vector<CuttableTissue::Glow> glows_;
  double moved_with_ = 0;        ///< [J] kinetic energy at the last calm()
  double calm_left_ = 0;         ///< [s] for which it is called
  bool touched_before_ = false;  ///< by any tool, as far as a tick ago: it may swing
};

}  // namespace palpate
