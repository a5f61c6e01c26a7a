#pragma once
#include <vector>

namespace palpate {

/// A sphere of the tool's surface for collision, centred on the shaft's axis.
struct SampleSphere {
  double behind = 0;  ///< [m] distance of its centre behind the tip's centre
  double radius = 0;  ///< [m]
};

/// The tip first, then the shaft at 1.5 radii from centre to centre, at most max_shaft_samples of them.
inline constexpr int max_shaft_samples = 47;
std::vector<SampleSphere> sample_tool(double tip_radius, double shaft_radius, double shaft_length);

}  // namespace palpate
