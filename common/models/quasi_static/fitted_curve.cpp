#include "common/models/quasi_static/fitted_curve.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "common/geometry/dense_solvers.hpp"

namespace palpate {
namespace {

constexpr double kBegin = 1e-3;  // of the first point: where a curve is as good as at its beginning

}  // namespace

FittedCurve::FittedCurve(const std::vector<double>& s, const std::vector<double>& y, int degree, Error error)
    : count_(degree), end_(s.empty() ? 0 : s.back()) {
  const auto points = static_cast<Eigen::Index>(s.size());
  if (degree < 1 || degree > kMaxDegree || points < degree || s.size() != y.size() || !(s.front() > 0))
    throw std::invalid_argument("a fit needs a degree of 1 to 10 and at least that many points beyond the origin");

  Eigen::MatrixXd basis(points, degree);
  for (Eigen::Index i = 0; i < points; ++i) {
    const double t = 2 * s[i] / end_ - 1, weight = error == Error::relative ? 1 : s[i] / end_;
    double before = t, now = 1;  // T_-1 = T_1
    for (int k = 0; k < degree; ++k) {
      basis(i, k) = weight * now;
      before = std::exchange(now, 2 * t * now - before);
    }
  }
  Eigen::VectorXd right = Eigen::Map<const Eigen::VectorXd>(y.data(), points);
  if (error == Error::relative)
    for (Eigen::Index i = 0; i < points; ++i) right[i] *= end_ / s[i];
  const Eigen::VectorXd solution = least_squares(basis, right) / end_;
  std::copy_n(solution.data(), degree, coefficient_.begin());
  end_ratio_ = ratio(end_);
  end_slope_ = slope(end_);
}

void FittedCurve::add(double share, const FittedCurve& other) {
  count_ = std::max(count_, other.count_);
  for (int k = 0; k < other.count_; ++k) coefficient_[k] += share * other.coefficient_[k];
  end_ += share * other.end_;
  end_ratio_ += share * other.end_ratio_;
  end_slope_ += share * other.end_slope_;
}

double FittedCurve::ratio(double s) const {
  s = std::abs(s);
  if (s > end_) return (end_ * end_ratio_ + end_slope_ * (s - end_)) / s;
  const double t = 2 * s / end_ - 1;
  double b1 = 0, b2 = 0;  // Clenshaw
  for (int k = count_ - 1; k > 0; --k) b2 = std::exchange(b1, 2 * t * b1 - b2 + coefficient_[k]);
  return t * b1 - b2 + coefficient_[0];
}

double FittedCurve::slope(double s) const {
  s = std::min(std::abs(s), end_);
  // y' = R + s dR/ds, both by Clenshaw; the derivative's recurrence runs along.
  const double t = 2 * s / end_ - 1;
  double b1 = 0, b2 = 0, d1 = 0, d2 = 0;
  for (int k = count_ - 1; k > 0; --k) {
    d2 = std::exchange(d1, 2 * b1 + 2 * t * d1 - d2);
    b2 = std::exchange(b1, 2 * t * b1 - b2 + coefficient_[k]);
  }
  const double ratio = t * b1 - b2 + coefficient_[0], derivative = b1 + t * d1 - d2;
  return ratio + s * derivative * 2 / end_;
}

double FittedCurve::first_fall() const {
  // On [-1, 1] a polynomial p of degree 9 has |p''| <= 9^2 (9^2 - 1)/3 max|p| = 2160 max|p|. With 5000
  // intervals it dips below its neighbouring points by at most 2160 (2e-4)^2/2 max|p| < 1e-4 max|p|.
  constexpr int kIntervals = 5000;
  double greatest = 0;
  for (int i = 0; i <= kIntervals; ++i) greatest = std::max(greatest, std::abs(slope(end_ * i / kIntervals)));
  for (int i = 0; i <= kIntervals; ++i) {
    const double s = end_ * i / kIntervals;
    if (slope(s) <= 1e-4 * greatest) return s;
  }
  return -1;
}

FittedCurve fit_rising(std::vector<double> s, std::vector<double> y, int degree) {
  const double begin = kBegin * s.front();
  s.insert(s.begin(), begin);
  y.insert(y.begin(), begin);
  for (int d = std::min(degree, static_cast<int>(s.size())); d > 0; --d)
    if (const FittedCurve curve(s, y, d, FittedCurve::Error::relative); curve.first_fall() < 0) return curve;
  return {{s.back()}, {s.back()}, 1};
}

}  // namespace palpate
