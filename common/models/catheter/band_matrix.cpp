#include "common/models/catheter/band_matrix.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {

BandMatrix::BandMatrix(int particles)
    : order_(3 * particles), entry_(static_cast<std::size_t>(kColumn) * (3 * particles + kBand), 0.0) {}

void BandMatrix::set_zero() {
  std::fill(entry_.begin(), entry_.end(), 0.0);
}

void BandMatrix::add(int i, int apart, const Eigen::Matrix3d& block) {
  for (int c = 0; c < 3; ++c) {
    double* below = column(3 * i + c) + 3 * apart - c;
    for (int r = apart == 0 ? c : 0; r < 3; ++r) below[r] += block(r, c);
  }
}

bool BandMatrix::factorise() {
  for (int j = 0; j < order_; ++j) {
    double* a = column(j);
    if (!(a[0] > 0)) return false;
    const double inverse = 1 / std::sqrt(a[0]);
    a[0] = inverse;
    for (int k = 1; k <= kBand; ++k) a[k] *= inverse;
    for (int c = 1; c <= kBand; ++c) {
      double* b = a + kColumn * c - c;
      for (int r = c; r <= kBand; ++r) b[r] -= a[c] * a[r];
    }
  }
  return true;
}

void BandMatrix::solve(std::span<double> x) const {
  std::fill(x.begin() + order_, x.begin() + order_ + kBand, 0.0);
  for (int j = 0; j < order_; ++j) {
    const double* a = column(j);
    double* y = x.data() + j;
    const double value = y[0] * a[0];
    y[0] = value;
    for (int k = 1; k <= kBand; ++k) y[k] -= a[k] * value;
  }
  std::fill(x.begin() + order_, x.begin() + order_ + kBand, 0.0);
  for (int j = order_ - 1; j >= 0; --j) {
    const double* a = column(j);
    double* y = x.data() + j;
    // The nearest unknown, which has just become known, comes last.
    const double far = (a[8] * y[8] + a[7] * y[7]) + (a[6] * y[6] + a[5] * y[5]);
    const double near = (a[4] * y[4] + a[3] * y[3]) + a[2] * y[2];
    y[0] = ((y[0] - far - near) - a[1] * y[1]) * a[0];
  }
}

}  // namespace palpate
