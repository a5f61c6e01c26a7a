#pragma once
#include <vector>

#include "common/archive/archive.hpp"
#include "common/scene/scene.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {

/// Tries a motion of one tool in lock step; the others follow their scripts, or stand.
class Rehearsal {
 public:
  /// The archives' surfaces, one a body. Both outlive this object.
  Rehearsal(const Scene& scene, const std::vector<Archive>& archives, int tool)
      : scene_(scene), archives_(archives), tool_(tool) {}

  double dt() const { return 1 / scene_.rates.haptic_hz; }  ///< [s] of a step
  /// [N] on the tool after each step. Throws std::runtime_error if the scene cannot be run, or a tool starts in
  /// contact.
  std::vector<double> forces(const Trajectory& motion) const;

 private:
  const Scene& scene_;
  const std::vector<Archive>& archives_;
  int tool_;
};

}  // namespace palpate
