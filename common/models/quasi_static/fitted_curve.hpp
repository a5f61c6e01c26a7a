#pragma once
#include <array>
#include <vector>

namespace palpate {

/// A measured curve y(s) through the origin as the polynomial y = s R(s), fitted by least squares. R is a
/// Chebyshev series in the scaled variable 2 s/end - 1, so that y(s)/s needs no division. Beyond the last
/// data point the curve goes on as a straight line with its end slope; to the left of the origin it is odd.
class FittedCurve {
 public:
  static constexpr int kMaxDegree = 10;

  /// A curve through which nothing goes yet: see add().
  FittedCurve() = default;
  enum class Error { absolute, relative };  ///< whose squares are least: of y, or of y(s)/s
  /// Fits y of the given degree (1 .. 10). `s` is positive and increases strictly; at least `degree` points.
  /// Throws std::invalid_argument.
  FittedCurve(const std::vector<double>& s, const std::vector<double>& y, int degree, Error error = Error::absolute);

  /// Adds a share of another curve: its end by that share, and by that share its shape y/end over s/end. Shares of
  /// rising curves that sum to 1 make a rising curve, and one that goes over evenly as the shares do.
  void add(double share, const FittedCurve& other);

  double end() const { return end_; }  ///< the last data point's s
  double ratio(double s) const;        ///< y(s)/s, and y'(0) at s = 0; a few nanoseconds
  double value(double s) const { return s * ratio(s); }
  double slope(double s) const;  ///< y'(s)

  /// Where the slope is not positive, the first such s of a fine scan of (0, end); -1 if it is positive
  /// throughout. The scan is fine enough to be a proof: Markov's inequality bounds what a polynomial of this
  /// degree can do between two of its points.
  double first_fall() const;

 private:
  int count_ = 0;                                 ///< coefficients of R: the degree of y
  std::array<double, kMaxDegree> coefficient_{};  ///< of R
  double end_ = 0, end_ratio_ = 0, end_slope_ = 0;
};

/// A curve that rises throughout and begins as y = s: of the highest degree up to `degree` whose fit of least relative
/// error does. A straight line where no other does, and y = s where that falls too. Points as for a FittedCurve, of any
/// number above zero.
FittedCurve fit_rising(std::vector<double> s, std::vector<double> y, int degree);

}  // namespace palpate
