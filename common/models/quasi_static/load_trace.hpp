#pragma once
#include <Eigen/Core>
#include <array>

#include "common/contact/creep.hpp"

namespace palpate {

/// The end of the last step, or that of the next one as it will be but for its own forces.
enum class Moment { now, ahead };

/// The forces s of CreepStep at one node [N].
using LaggingForces = std::array<Eigen::Vector3d, Relaxation::kMaxTerms>;
inline LaggingForces no_lag() {
  LaggingForces lag;
  lag.fill(Eigen::Vector3d::Zero());
  return lag;
}

/// What one node's forces up to now do in a body that relaxes.
struct LoadTrace {
  int node = -1;
  int idle = 0;                                      ///< steps since it carried force
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N] on the tissue, of the last step
  Eigen::Vector3d before = Eigen::Vector3d::Zero();  ///< [N] of the step before it
  LaggingForces lag = no_lag();                      ///< at the end of the last step

  /// Goes on by a step whose force is `force` now.
  void follow(const CreepStep& step) {
    for (std::size_t k = 0; k < step.terms().size(); ++k) {
      const CreepStep::Term& term = step.terms()[k];
      lag[k] = term.keep * lag[k] + term.old * before + term.fresh * force;
    }
    idle = force.isZero(0) ? idle + 1 : 0;
  }

  /// [N] Sum of gain s: the load that does to elastic tissue what the past does to this one.
  Eigen::Vector3d creep_load(const CreepStep& step) const {
    Eigen::Vector3d load = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < step.terms().size(); ++k) load += step.terms()[k].gain * lag[k];
    return load;
  }

  /// [N] The load under which elastic tissue would have the displacement u: f + sum of gain s.
  Eigen::Vector3d load(const CreepStep& step, Moment moment) const {
    if (moment == Moment::now) return force + creep_load(step);
    Eigen::Vector3d ahead = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < step.terms().size(); ++k) {
      const CreepStep::Term& term = step.terms()[k];
      ahead += term.gain * (term.keep * lag[k] + term.old * force);
    }
    return ahead;
  }
};

}  // namespace palpate
