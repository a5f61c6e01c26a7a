// Frequencies of shells against closed forms and published values. scripts/modal_plots.py makes a table of
// docs/modes.md of these rows.
#include <fmt/format.h>

#include <cmath>

#include "bench/report.hpp"
#include "bench/shell_bodies.hpp"
#include "common/geometry/principal_axes.hpp"
#include "common/shell/modes.hpp"

namespace palpate::bench {
namespace {

using Eigen::MatrixXd;
using std::numbers::pi;

void row(const std::string& name, const std::string& metric, double value, std::string_view unit) {
  report("modal_frequencies", name, metric, value, unit);
}

void frequencies(const std::string& name, const ShellSystem& system, double shift, int rigid,
                 const std::vector<double>& hertz) {
  const int count = rigid + static_cast<int>(hertz.size());
  Modes modes;
  const double seconds = seconds_of([&] { modes = lowest_modes(system.stiffness, system.mass, count, shift); });
  double worst = 0;
  for (std::size_t i = 0; i < hertz.size(); ++i) {
    const double found = modes.omega[rigid + static_cast<int>(i)] / (2 * pi);
    row(name, fmt::format("mode{}", i + 1), found, "Hz");
    row(name, fmt::format("expected{}", i + 1), hertz[i], "Hz");
    worst = std::max(worst, std::abs(found / hertz[i] - 1));
  }
  const MatrixXd product = modes.shape.transpose() * system.mass.asDiagonal() * modes.shape;
  row(name, "worst_error", worst, "1");
  row(name, "orthonormality", (product - MatrixXd::Identity(count, count)).cwiseAbs().maxCoeff(), "1");
  row(name, "translations", system.translations(), "1");
  row(name, "time", seconds, "s");
}

/// sqrt(D / rho t) / (2 pi) of the plate [m^2/s].
double plate_unit() {
  const double rigidity = kSteel.young * std::pow(kSteel.thickness, 3) / 12 / (1 - kSteel.poisson * kSteel.poisson);
  return std::sqrt(rigidity / (kSteel.density * kSteel.thickness)) / (2 * pi);
}

/// Frequency [Hz] of m half waves along and n waves around: Sanders' theory, exact for ends held by
/// diaphragms.
double cylinder_frequency(int m, int n) {
  const double l = m * pi / kCylinderLength, r = kCylinderRadius, nu = kCylinder.poisson;
  const double stretch = kCylinder.young * kCylinder.thickness / (1 - nu * nu);
  using Row = Eigen::RowVector3d;  // of the amplitudes along, around, outward
  const Row strain[] = {Row(-l, 0, 0), Row(0, n / r, 1 / r), Row(-n / r, l, 0)};
  const Row bend[] = {Row(0, 0, l * l), Row(0, n / (r * r), n * n / (r * r)),
                      Row(n / (2 * r * r), 3 * l / (2 * r), 2 * n * l / r)};
  const auto energy = [&](const Row* e) -> Eigen::Matrix3d {
    const Eigen::Matrix3d cross = e[0].transpose() * e[1];
    return e[0].transpose() * e[0] + e[1].transpose() * e[1] + nu * (cross + cross.transpose()) +
           (1 - nu) / 2 * e[2].transpose() * e[2];
  };
  const Eigen::Matrix3d k = stretch * (energy(strain) + std::pow(kCylinder.thickness, 2) / 12 * energy(bend));
  const double square = principal_values(k)[0];
  return std::sqrt(square / (kCylinder.density * kCylinder.thickness)) / (2 * pi);
}

void known_frequencies() {
  std::vector<double> supported, free, round;
  for (int square : {2, 5, 5, 8, 10, 10, 13, 13}) supported.push_back(pi * pi * square / 100 * plate_unit());
  for (double lambda : {13.4682, 19.5961, 24.2702, 34.8009, 34.8009, 61.0932, 61.0932})
    free.push_back(lambda / 100 * plate_unit());
  for (int m = 1; m <= 4; ++m)
    for (int n = 1; n <= 8; ++n) round.insert(round.end(), 2, cylinder_frequency(m, n));
  std::sort(round.begin(), round.end());
  round.resize(10);
  frequencies("plate_supported", supported_plate(28), 0, 0, supported);
  frequencies("plate_free", free_plate(28), 100, 6, free);
  frequencies("cylinder", cylinder(64, 40), 1e4, 1, round);
  frequencies("tapered_membrane", tapered_membrane(28), 0, 0, {44.623, 130.03, 162.70, 246.05, 379.90, 391.44});
  std::vector<double> bending;
  for (double root : {1.87510, 4.69409, 7.85476})
    bending.push_back(root * root / (2 * pi) *
                      std::sqrt(kStrip.young * std::pow(kStrip.thickness, 2) / 12 / kStrip.density) /
                      std::pow(kStripLength, 2));
  frequencies("cantilever_strip", cantilever_strip(28), 0, 0, bending);
}

}  // namespace
}  // namespace palpate::bench

int main() {
  palpate::bench::known_frequencies();
}
