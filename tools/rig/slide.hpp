#pragma once
#include <span>
#include <vector>

#include "tools/rig/press_rig.hpp"
#include "tools/rig/surface_path.hpp"

namespace palpate {

inline constexpr double kSlideSpeed = 0.05;  ///< [m/s] at which slides are made

/// One tick of a slide.
struct SlideTick {
  double path;        ///< [m] of the tip over the surface; negative in the run-up
  double force;       ///< [N] its size
  double tangential;  ///< [N] on the tool, along the motion, of what is not along its contacts' normals: negative
                      ///< holds the tool back
};

/// Presses a rig's only tool, a ball, into the first place of a path at the slide's speed, lets it rest, and leads it
/// over the path at a constant depth [m], a place a tick.
std::vector<SlideTick> slide(PressRig& rig, const SurfacePath& path, double radius, double depth);

/// Forces [N] along the press at places of one side of a body, each come to from above and held at a depth [m] until it
/// rests. The rig is started, and its ball within half its radius of the first.
std::vector<double> press_places(PressRig& rig, std::span<const SurfacePlace> places, double radius, double depth);

/// How smooth a slide feels. All but the mean are shares of it.
struct SlideMeasures {
  double mean = 0;    ///< [N]
  double ripple = 0;  ///< root mean square of the force about its smooth trend
  double jump = 0;    ///< largest change from one tick to the next
  double turn = 0;    ///< of ticks in which the tool is pushed along its motion by more than 0.002 of the force
  double buzz = 0;    ///< root mean square of the force about its trend, between 100 and 500 Hz
};

/// Of the ticks after the run-up. `trend`: of the force at each of all ticks; in shape alone, since it is scaled to the
/// force. `dt` [s] of a tick.
SlideMeasures measure_slide(std::span<const SlideTick> ticks, std::span<const double> trend, double dt);

/// The line through the forces after the run-up: what a slide over a flat block is measured about.
std::vector<double> line_through(std::span<const SlideTick> ticks);

/// (largest - least) / mean.
double spread_of(std::span<const double> values);

}  // namespace palpate
