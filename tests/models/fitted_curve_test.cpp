#include "common/models/quasi_static/fitted_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

namespace palpate {
namespace {

FittedCurve fit(const std::function<double(double)>& y, double end, int points, int degree) {
  std::vector<double> s, values;
  for (int i = 1; i <= points; ++i) {
    s.push_back(end * i / points);
    values.push_back(y(s.back()));
  }
  return {s, values, degree};
}

TEST(FittedCurve, APolynomialOfItsDegreeIsReproduced) {
  // In millimetres written as metres: raw powers would lose all digits at degree 10.
  const auto y = [](double s) {
    const double t = s / 0.004;
    return 2 * t + 0.3 * t * t - 0.1 * std::pow(t, 5) + 0.7 * std::pow(t, 10);
  };
  const FittedCurve curve = fit(y, 0.004, 40, 10);
  for (double s = 1e-5; s <= 0.004; s += 1e-5) ASSERT_NEAR(curve.value(s), y(s), 1e-11);
}

TEST(FittedCurve, RatioTendsToTheSlopeAtTheOrigin) {
  const FittedCurve curve = fit([](double s) { return 3 * s + 5 * s * s + s * s * s * s; }, 1, 20, 4);
  EXPECT_NEAR(curve.ratio(0), 3, 1e-11);
  EXPECT_NEAR(curve.slope(0), 3, 1e-11);
  EXPECT_EQ(curve.value(0), 0);
  EXPECT_NEAR(curve.ratio(1e-300), 3, 1e-11);
}

TEST(FittedCurve, SlopeIsTheDerivative) {
  const FittedCurve curve = fit([](double s) { return std::sinh(2 * s); }, 1.3, 30, 7);
  for (double s = 0.01; s < 2; s += 0.01) {
    const double h = 1e-6;
    ASSERT_NEAR(curve.slope(s), (curve.value(s + h) - curve.value(s - h)) / (2 * h), 1e-5) << s;
  }
}

TEST(FittedCurve, GoesOnAsAStraightLineBeyondItsData) {
  const FittedCurve curve = fit([](double s) { return s + std::pow(s, 8); }, 1, 30, 8);
  EXPECT_NEAR(curve.value(3), 2 + 9 * 2, 1e-8);
  EXPECT_NEAR(curve.slope(100), 9, 1e-8);
  EXPECT_NEAR(curve.value(1 + 1e-12), curve.value(1), 1e-10);
}

TEST(FittedCurve, IsOdd) {
  const FittedCurve curve = fit([](double s) { return s + s * s; }, 1, 10, 4);
  EXPECT_EQ(curve.value(-0.5), -curve.value(0.5));
  EXPECT_EQ(curve.value(-2), -curve.value(2));
}

TEST(FittedCurve, FindsWhereItFalls) {
  EXPECT_EQ(fit([](double s) { return s + s * s * s; }, 1, 20, 4).first_fall(), -1);
  // 3 s^2 - 2 s^3 + 0.5 s rises up to s = (1 + sqrt(4/3))/2 and falls beyond
  const FittedCurve hump = fit([](double s) { return 0.5 * s + 3 * s * s - 2 * s * s * s; }, 1.4, 40, 4);
  EXPECT_NEAR(hump.first_fall(), (1 + std::sqrt(4.0 / 3)) / 2, 1e-3);
  EXPECT_EQ(fit([](double s) { return -s; }, 1, 20, 4).first_fall(), 0);
}

TEST(FittedCurve, AShortDipIsNotMissed) {
  // Slope (s - 0.503)^2 - 1e-4: negative over two hundredths of the range only.
  const FittedCurve dip =
      fit([](double s) { return (std::pow(s - 0.503, 3) + std::pow(0.503, 3)) / 3 - 1e-4 * s; }, 1, 50, 4);
  EXPECT_NEAR(dip.first_fall(), 0.493, 5e-3);
}

TEST(FittedCurve, RefusesWhatCannotBeFitted) {
  EXPECT_THROW(FittedCurve({1, 2, 3}, {1, 2, 3}, 4), std::invalid_argument);
  EXPECT_THROW(FittedCurve({0, 1, 2, 3}, {0, 1, 2, 3}, 4), std::invalid_argument);
  EXPECT_THROW(FittedCurve({}, {}, 4), std::invalid_argument);
}

}  // namespace
}  // namespace palpate
