#pragma once
#include <Eigen/Core>
#include <vector>

#include "common/describe/state.hpp"
#include "common/dynamics/dynamic_model.hpp"

namespace palpate {

/// How many ticks of `dt` [s] what has been cut away takes to fade.
int fading_ticks(double dt);

/// What tetrahedra that have been cut away did to the nodes that stay, and the contacts that pressed them: gone at
/// once, it would be a blow to the tissue.
class FadingLoads {
 public:
  /// For ticks of `dt` [s].
  explicit FadingLoads(double dt) : ticks_(fading_ticks(dt)) {}

  /// `force` [N] fades from now on.
  void add(int node, const Eigen::Vector3d& force) { loads_.push_back({node, ticks_, force}); }
  /// Once a tick: the model's loads are less of them than in the last one.
  void fade(DynamicModel& model);

  void state(State& s) { s.list(loads_); }
  bool fits(int nodes) const;  ///< whether what was restored can be of so many nodes

 private:
  struct Load {
    int node, ticks_left;
    Eigen::Vector3d force;  ///< [N] at first
  };
  int ticks_;
  std::vector<Load> loads_;
};

}  // namespace palpate
