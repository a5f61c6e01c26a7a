#pragma once
#include <span>
#include <vector>

#include "common/models/quasi_static/fading_field.hpp"

namespace palpate {

/// What the forces of the past do to a quasi-static body that relaxes. All moduli relax alike, so that its
/// displacements are those of the elastic body under the loads f + sum of gain s, node by node (CreepStep): a trace a
/// node while it carries force, and a field for what is left of the loads that have ended. A step of it is
///   displacement at Moment::ahead, solving for the new forces, begin(), add() for each of them, end();
/// the step's own forces meet a compliance that is CreepStep::instant() times the archive's. Nothing is allocated after
/// construction.
class ForceMemory {
 public:
  /// `softened`: that compliance, which outlives this object. `max_loaded`: nodes that carry force at once, at most.
  ForceMemory(const CreepStep& step, const Compliance<double>& softened, std::size_t max_loaded);
  ForceMemory(const ForceMemory&) = delete;

  void begin();
  void add(int node, const Eigen::Vector3d& force);  ///< [N] on the tissue; several of a node add up
  void end();

  /// The displacement by all traces is that of `softened` under the loads visited here, (node, [N]); add_faded() adds
  /// the rest [m], three entries a node.
  template <class Visit>
  void for_each_load(Moment moment, Visit&& visit) const {
    for (const LoadTrace& t : traces_) visit(t.node, Eigen::Vector3d(t.load(step_, moment) / step_.instant()));
  }
  void add_faded(Moment moment, std::span<const int> nodes, std::span<double> displacement) const {
    faded_.add(moment, nodes, displacement);
  }

  /// Visits (node, sum of gain s [N]), the loads that stand for the past; a node may come several times.
  template <class Visit>
  void for_each_creep_load(Visit&& visit) const {
    for (const LoadTrace& t : traces_) visit(t.node, t.creep_load(step_));
    faded_.for_each_load(visit);
  }
  /// Creep loads there can be.
  std::size_t max_creep_loads() const { return room_ + FadingField::kMaxLoads + 1; }
  std::size_t max_loads() const { return room_; }  ///< that for_each_load() visits

  void state(State& s);

 private:
  LoadTrace& longest_idle();
  void hand_over(LoadTrace& trace);

  const CreepStep step_;
  const Compliance<double>& softened_;
  std::size_t room_;
  std::vector<LoadTrace> traces_;
  std::vector<int> trace_of_;  ///< per touchable node; -1: none
  FadingField faded_;
};

}  // namespace palpate
