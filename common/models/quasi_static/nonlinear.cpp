#include "common/models/quasi_static/nonlinear.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "common/describe/csv.hpp"

namespace palpate {

namespace {

constexpr int kDegree = 4;      // of the curves through computed presses
constexpr double kSpot = 1e-4;  // [m] about a place within which the others do not count

/// The true answer over the linear one.
FittedCurve fit_pairs(const std::vector<PressedPlace::Pair>& pairs) {
  std::vector<double> linear, truth;
  for (const auto& [l, t] : pairs) {
    linear.push_back(l);
    truth.push_back(t);
  }
  return fit_rising(linear, truth, kDegree);
}

/// y = s.
FittedCurve unchanged() {
  return {{1.0}, {1.0}, 1};
}

/// Fits the measured values over the linear answer `slope` x to the same displacements x.
FittedCurve read_curve(const std::filesystem::path& file, std::string_view column, double slope, int degree) {
  const CsvTable table = read_csv(file, {"displacement_m", column});
  std::vector<double> linear, measured;
  double before = -1, greatest = 0;
  for (const CsvRow& row : table.rows) greatest = std::max(greatest, std::abs(row.values[1]));
  for (const CsvRow& row : table.rows) {
    const double x = row.values[0], y = row.values[1];
    if (x < 0) table.fail(row.line, fmt::format("the displacement {} is negative; loading counts from 0", x));
    if (x <= before) table.fail(row.line, fmt::format("the displacement {} does not come after {}", x, before));
    before = x;
    if (x == 0 && std::abs(y) > 1e-3 * greatest)
      table.fail(row.line, fmt::format("the curve must pass through zero, and is {} without displacement", y));
    if (x == 0) continue;
    linear.push_back(slope * x);
    measured.push_back(y);
  }
  if (static_cast<int>(linear.size()) < degree)
    table.fail(
        table.rows.back().line,
        fmt::format("a fit of degree {} needs as many points beyond zero, and there are {}", degree, linear.size()));
  return {linear, measured, degree};
}

FittedCurve read_force_curve(const MeasuredLaw& nonlinear, double slope) {
  FittedCurve curve = read_curve(nonlinear.force_curve, "force_N", slope, nonlinear.degree);
  const double fall = curve.first_fall();
  if (fall >= 0)
    throw std::runtime_error(
        fmt::format("{}: the force of the fit of degree {} would fall while the tool advances, at a "
                    "displacement of {:.6g} m",
                    nonlinear.force_curve.string(), nonlinear.degree, fall / slope));
  return curve;
}

FittedCurve read_radial_curve(const MeasuredLaw& nonlinear, double slope) {
  if (!(slope > 0))
    throw std::runtime_error(fmt::format(
        "{}: the radial curve needs a linear model that widens under a press: poisson must be greater than 0",
        nonlinear.radial_curve.string()));
  return read_curve(nonlinear.radial_curve, "radial_m", slope, nonlinear.degree);
}

}  // namespace

LinearSlopes sliding_slopes(const Material& material, double radius, double height) {
  const double section = std::numbers::pi * radius * radius;
  return {section * material.young / height, material.poisson * radius / height};
}

QuasiNonlinear measured_correction(const MeasuredLaw& law, const LinearSlopes& linear) {
  return {read_force_curve(law, linear.force), read_radial_curve(law, linear.radial)};
}

BodyNonlinear::BodyNonlinear(const std::vector<PressedPlace>& presses) {
  for (const PressedPlace& press : presses) {
    place_.push_back(press.at);
    law_.emplace_back(fit_pairs(press.force), press.radial.empty() ? unchanged() : fit_pairs(press.radial));
  }
}

QuasiNonlinear BodyNonlinear::at(const Eigen::Vector3d& place) const {
  if (place_.empty()) return law_.front();
  const auto weight = [&](std::size_t i) {
    const double square = (place - place_[i]).squaredNorm() + kSpot * kSpot;
    return 1 / (square * square);
  };
  double sum = 0;
  for (std::size_t i = 0; i < place_.size(); ++i) sum += weight(i);
  QuasiNonlinear law;
  for (std::size_t i = 0; i < place_.size(); ++i) law.add(weight(i) / sum, law_[i]);
  return law;
}

namespace {

QuasiNonlinear correction_of(const MeasuredLaw& law, const QuasiStaticSpec& body, const Archive& archive) {
  if (law.specimen_mesh.empty())
    return measured_correction(law, sliding_slopes(body.material, law.specimen_radius, law.specimen_height));
  if (!(archive.specimen_force_slope > 0))
    throw std::runtime_error(fmt::format("the archive of body '{}' holds no press of its specimen", body.name));
  return measured_correction(law, {archive.specimen_force_slope, archive.specimen_radial_slope});
}

const std::vector<PressedPlace>& correction_of(const NeoHookeanLaw&, const QuasiStaticSpec& body,
                                               const Archive& archive) {
  if (archive.presses.empty())
    throw std::runtime_error(fmt::format("the archive of body '{}' holds no presses of it", body.name));
  return archive.presses;
}

}  // namespace

BodyNonlinear make_nonlinear(const QuasiStaticSpec& body, const Archive& archive) {
  return std::visit([&](const auto& law) { return BodyNonlinear(correction_of(law, body, archive)); },
                    body.nonlinear->law);
}

template <class Scalar>
void add_corrected(const QuasiNonlinear& law, std::span<const Scalar> linear, const Eigen::Vector3d& press,
                   std::span<Scalar> total) {
  using Vector = Eigen::Matrix<Scalar, 3, 1>;
  for (std::size_t i = 0; i + 2 < linear.size(); i += 3) {
    const Vector u = Eigen::Map<const Vector>(linear.data() + i);
    Eigen::Map<Vector>(total.data() + i) += law.correct(u.template cast<double>(), press).template cast<Scalar>();
  }
}

template <class Scalar>
void keep_held(std::span<const int> held, std::span<const Scalar> linear, std::span<Scalar> total) {
  for (const int n : held) std::copy_n(linear.begin() + 3 * n, 3, total.begin() + 3 * n);
}

template void add_corrected(const QuasiNonlinear&, std::span<const float>, const Eigen::Vector3d&, std::span<float>);
template void add_corrected(const QuasiNonlinear&, std::span<const double>, const Eigen::Vector3d&, std::span<double>);
template void keep_held(std::span<const int>, std::span<const float>, std::span<float>);
template void keep_held(std::span<const int>, std::span<const double>, std::span<double>);

}  // namespace palpate
