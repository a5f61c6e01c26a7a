#include <gtest/gtest.h>

#include <numbers>

#include "common/shell/condensation.hpp"
#include "common/shell/full_newmark.hpp"
#include "common/shell/modes.hpp"
#include "tests/shell/modal_shells.hpp"

namespace palpate {
namespace {

using Eigen::VectorXd;
using std::numbers::pi;
using namespace testing;

/// A shell that vibrates freely, every mode with the same part in the displacement at the beginning.
class FreeVibration {
 public:
  explicit FreeVibration(ShellSystem system) : system_(std::move(system)) {
    const int n = system_.translations();
    const auto modes = lowest_modes(system_.stiffness, system_.mass, n);
    condensed_ = condense_rotations(system_.stiffness, n);
    start_ = modes.shape * VectorXd::Constant(n, 1e-6);
    shortest_ = 2 * pi / modes.omega[n - 1];
  }

  double limit() const { return shortest_ / pi; }  // T_n / pi

  /// Largest displacement within that many steps, of the largest at the beginning.
  template <class Scheme>
  double growth(double h, int steps) const {
    const VectorXd none = VectorXd::Zero(start_.size());
    Scheme scheme(condensed_, system_.mass, 0, h);
    scheme.start(start_, none, none);
    double largest = 0;
    for (int i = 0; i < steps; ++i) {
      scheme.step(none);
      largest = std::max(largest, scheme.displacement().norm());
      if (!(largest < 1e100)) break;
    }
    return largest / start_.norm();
  }

 private:
  ShellSystem system_;
  Eigen::MatrixXd condensed_;
  VectorXd start_;
  double shortest_;
};

TEST(CentralDifference, IsStableBelowTheShortestPeriodOverPiAndUnstableAbove) {
  for (const auto& system : {duct(8, 5), supported_plate(8)}) {
    const FreeVibration vibration(system);
    EXPECT_LT(vibration.growth<CentralDifference>(0.95 * vibration.limit(), 4000), 10);
    EXPECT_GT(vibration.growth<CentralDifference>(1.05 * vibration.limit(), 400), 1e20);
  }
}

TEST(CentralDifference, NewmarkIsStableOnBothSidesAndFarBeyond) {
  for (const auto& system : {duct(8, 5), supported_plate(8)}) {
    const FreeVibration vibration(system);
    for (double factor : {0.95, 1.05, 10.0, 1e3, 1e5})
      EXPECT_LT(vibration.growth<FullNewmark>(factor * vibration.limit(), 2000), 10) << factor;
  }
}

}  // namespace
}  // namespace palpate
