#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/contact/cut_surface.hpp"
#include "common/contact/step_settings.hpp"
#include "common/describe/state.hpp"
#include "common/dynamics/dynamic_model.hpp"
#include "common/dynamics/elastic_mesh.hpp"
#include "common/dynamics/spec.hpp"
#include "common/dynamics/tearing.hpp"
#include "common/mesh/shown_surface.hpp"
#include "common/models/moving/fading_loads.hpp"
#include "common/models/moving/floating_part.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// Moving tissue that tetrahedra can leave: which are there, the surface that they have, what the others feel of those
/// that go, and what hangs on nothing any more.
class CuttableTissue {
 public:
  /// `archive` and `settings` are looked at here alone, the other two outlive this object. `joined`: nodes at which the
  /// tissue hangs on a quasi-static part; their loads are that part's.
  CuttableTissue(const Archive& archive, const MovingSpec& body, const StepSettings& settings, const ElasticMesh& mesh,
                 DynamicModel& model, std::span<const int> joined);

  /// What glows of a tool.
  struct Glow {
    Eigen::Vector3d tip;  ///< [m]
    double radius;        ///< [m]
  };
  struct Change {
    RemovalCause cause;
    std::vector<int> removed;  ///< in order, with those that conformity asked for
  };

  // Each says whether anything has gone. `position` [m]: per node.

  /// What the glowing spheres touch with their visible facets, the nearest first, some at most for each.
  bool cut(std::span<const Glow> glows);
  /// What is deformed beyond the body's threshold, if it has one.
  bool tear(std::span<const Eigen::Vector3d> position);
  /// A part that floats and has gone far away is not followed for ever.
  bool drop_fallen(std::span<const Eigen::Vector3d> position);
  /// Before the first tick: these, all of this body, have gone before.
  bool begin_without(std::span<const std::uint32_t> removed);
  bool has(std::span<const std::uint32_t> tetrahedra) const;  ///< all are of this body, whether gone or not

  /// Before a tick: what has been cut away fades, and what floats is damped for its swinging alone.
  void begin_tick();
  /// Before each step of the tick, of `dt` [s]. `held`: what jaws hold.
  void begin_step(std::span<const JawHold> held, double dt);
  /// `force` [N], which was on a node, fades from now on.
  void fade(int node, const Eigen::Vector3d& force);

  const CutMesh& topology() const { return topology_; }
  const CutSurface& surface() const { return surface_; }
  CutSurface& surface() { return surface_; }
  /// Nodes by which the tissue hangs on a quasi-static part.
  bool is_joined(int node) const { return joined_[node] != 0; }
  /// Outward triangles that are seen. Valid until the next call.
  const std::vector<std::array<int, 3>>& shown() { return shown_.triangles(topology_); }
  /// Of this tick; empty most of the time.
  std::span<const Change> changes() const { return changes_; }
  const std::vector<int>& removed() const { return removed_; }  ///< all so far, in order

  /// What is gone, and the loads that fade. Only tissue that is whole restores.
  void state(State& s);

 private:
  void remove(int tetrahedron);
  void restore(std::span<const int> removed);
  bool note_change(RemovalCause cause, std::size_t first);
  void cut_from_model(std::span<const int> gone);
  bool fades(int node) const;  ///< what pressed it can: it is the moving part's alone, and there
  void find_floating();

  const ElasticMesh& mesh_;
  DynamicModel& model_;
  CutMesh topology_;
  ShownSurface shown_;
  CutSurface surface_;
  std::optional<TearSearch> tearing_;
  FadingLoads fading_;
  std::vector<char> joined_;  ///< per node
  double damping_;            ///< [1/s]
  double diagonal_;           ///< [m] of the body at rest
  Eigen::Vector3d middle_;    ///< [m] of the body at rest
  std::vector<int> removed_, part_of_;
  std::vector<FloatingPart> floating_;
  std::vector<Change> changes_;
};

}  // namespace palpate
