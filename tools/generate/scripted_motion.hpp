#pragma once
#include <string>
#include <vector>

#include "common/scene/scene.hpp"
#include "common/tool/kinematics.hpp"

namespace palpate {

/// Where a forceps works: its joint lies `ahead` [m] before `point` on the way from the trocar, and its jaws
/// open in the plane across `across` (as far as the shaft's direction allows).
struct JawTarget {
  Eigen::Vector3d point, across;
  double ahead = 0;
};

/// The dofs, grip excluded, that bring a forceps there.
ToolDofs dofs_for_jaws(const Trocar& trocar, const JawTarget& target);

/// Distance [m] from the line of a jaw, open by `opening` [rad] in all, to the line through the target's
/// point along `across`.
double jaw_distance(const Trocar& trocar, const JawTarget& target, double opening);

/// Writes a trajectory as one move after another; each begins and ends at rest.
class ScriptedMotion {
 public:
  ScriptedMotion(const Tool& tool, const JawTarget& start, double grip);

  void wait(double seconds);
  void move(double seconds,
            const JawTarget& target);  ///< in a straight line, with even acceleration and braking
  void grip(double seconds, double opening);

  double time() const { return time_.back(); }
  const JawTarget& target() const { return target_; }
  const Trocar& trocar() const { return trocar_; }
  std::string csv(const std::string& comment) const;  ///< as load_trajectory() reads it

 private:
  void add(double time, const ToolDofs& dofs);

  Trocar trocar_;
  JawTarget target_;
  std::vector<double> time_;
  std::vector<ToolDofs> dofs_;
};

}  // namespace palpate
