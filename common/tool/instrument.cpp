#include "common/tool/instrument.hpp"

namespace palpate {

std::vector<SampleSphere> sample_tool(double tip_radius, double shaft_radius, double shaft_length) {
  std::vector<SampleSphere> samples{{0, tip_radius}};
  const double step = 1.5 * shaft_radius;
  for (int i = 0; i < max_shaft_samples; ++i) {
    const double behind = tip_radius + i * step;
    if (behind > shaft_length) break;
    samples.push_back({behind, shaft_radius});
  }
  return samples;
}

}  // namespace palpate
