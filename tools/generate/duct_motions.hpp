#pragma once
#include <string>

#include "common/scene/scene.hpp"
#include "tools/generate/duct.hpp"

namespace palpate {

/// How a forceps feeds a catheter into the duct, hand over hand. Lengths [m], times [s], grips [rad].
struct FeedPlan {
  int strokes = 4;
  double stroke = 0.0095;  ///< fed in by each
  double nearest = 0.020;  ///< from the mouth to the jaws at the end of a stroke
  double share = 0.6;      ///< of the jaws' length at which the catheter lies
  double open = 0.9, closed = 0.30;
  double withdrawn = 0.030;  ///< the jaws wait so far away
  double approach_time = 2.0, grip_time = 0.8, stroke_time = 2.2, back_time = 1.2;
};

/// How another one steadies the duct near its mouth: its open jaws straddle it like a fork and push a little.
struct SteadyPlan {
  double place = 0.2;  ///< along the duct, 0 (mouth) .. 1
  double open = 1.2;
  double push = 0.003;  ///< beyond the touch
  double withdrawn = 0.030;
  double approach_time = 2.0, push_time = 0.8;
  double hold_until = 23.5;
};

/// How a forceps pokes the duct with its closed tips, pushes it aside with their flank, grasps and pulls it.
struct PokePlan {
  double poke_place = 0.30, push_place = 0.72, grasp_place = 0.5;  ///< along the duct
  double poke = 0.002, push = 0.003, pull = 0.004;                 ///< beyond the touch; back with the grasped duct
  double open = 1.5, closed = 0.95;
  double share = 0.6;  ///< of the jaws' length at which the duct lies
  double withdrawn = 0.025;
};

/// Trajectory files of a forceps, as text. `catheter`: as it lies at rest; `thickness` [m]: of the duct's wall.
std::string feeding_motion(const Tool& tool, const Catheter& catheter, const FeedPlan& plan = {});
std::string steadying_motion(const Tool& tool, const DuctShape& duct, double thickness, const SteadyPlan& plan = {});
std::string poking_motion(const Tool& tool, const DuctShape& duct, double thickness, const PokePlan& plan = {});

/// The motion of one tool of an example scene, by the tool's name: "right" feeds, "left" steadies, "forceps"
/// pokes. Throws std::runtime_error for another name, or where the scene lacks the body that the motion is
/// about.
std::string duct_motion(const Scene& scene, const Tool& tool);

}  // namespace palpate
