#pragma once
#include <cmath>
#include <vector>

#include "common/fem/relaxation_spec.hpp"

namespace palpate::testing {

/// The hereditary integral of E(t - s) / E0 over an elastic force that is given at each tick and changes evenly in
/// between (Lee & Radok 1960 eq. 12 where the contact grows): the force [N] at each tick. It was 0 before the first.
inline std::vector<double> relaxed(const Relaxation& relaxation, const std::vector<double>& elastic, double dt) {
  std::vector<double> forces;
  for (std::size_t n = 0; n < elastic.size(); ++n) {
    double sum = 0;
    for (std::size_t i = 0; i <= n; ++i) {
      double mean = 1;  // of E / E0 over the tick i
      for (std::size_t k = 0; k < relaxation.times.size(); ++k) {
        const double steps = dt / relaxation.times[k];
        mean -= relaxation.shares[k] * (1 + std::exp(-steps * static_cast<double>(n - i)) * std::expm1(-steps) / steps);
      }
      sum += mean * (elastic[i] - (i > 0 ? elastic[i - 1] : 0.0));
    }
    forces.push_back(sum);
  }
  return forces;
}

}  // namespace palpate::testing
