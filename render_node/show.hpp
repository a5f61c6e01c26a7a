#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/bus/presence.hpp"
#include "common/node/surface_source.hpp"
#include "common/node/topology_feed.hpp"
#include "render_node/stage.hpp"

namespace palpate {

/// A stage that follows the messages of a run: shapes, cuts, tools, forces and records of tasks.
class Show {
 public:
  Show(const Scene& scene, Stage stage, SurfaceSource& source, Bus& bus, const Presence& presence);

  /// The cuts of the scene's dynamic bodies; null, as at first, where there are none.
  void set_topology(TopologyFeed* topology) { topology_ = topology; }

  /// Takes what has come; true if a newer haptic step is on the stage.
  bool take();
  /// Words over the picture: the scene's title, these lines, and what is known of tasks and tools. Notes the moment of
  /// the greatest force.
  void tell(const std::vector<std::string>& lines);

  Frame frame() const { return stage_.frame(); }
  /// What was to be seen at the greatest force, or now if there was none.
  const Stage& best_moment() const { return best_ ? *best_ : stage_; }
  double peak_force() const { return peak_force_; }   ///< [N] at the moments that were told
  std::uint64_t refused() const { return refused_; }  ///< messages of other runs, or that do not fit the scene

 private:
  void follow_cuts();
  template <class M, class Take>
  void take_all(Reader<M>& reader, const Take& take);

  const Scene& scene_;
  Stage stage_;
  std::optional<Stage> best_;
  SurfaceSource& source_;
  const Presence& presence_;
  TopologyFeed* topology_ = nullptr;
  std::unique_ptr<Reader<ToolState>> tools_;
  std::unique_ptr<Reader<ForceState>> forces_;
  std::unique_ptr<Reader<TaskRecord>> tasks_;        ///< null: no catheter
  std::vector<ForceState> latest_force_;             ///< by tool
  std::map<std::uint32_t, TaskRecord> latest_task_;  ///< by catheter
  double peak_force_ = 0, best_force_ = 0;           ///< [N]; the second at the best moment
  std::uint64_t refused_ = 0;
};

}  // namespace palpate
