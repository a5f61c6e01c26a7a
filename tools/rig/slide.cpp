#include "tools/rig/slide.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kRest = 200;                       // ticks
constexpr double kAbove = -0.5;                  // radii of depth from which a ball comes
constexpr double kPushed = 0.002;                // of the force
constexpr double kLowest = 100, kHighest = 500;  // [Hz] of what is felt as a buzz

/// The root mean square of what lies between two frequencies [Hz], seen through Hann's window.
double band(std::span<const double> values, double dt) {
  const auto n = static_cast<double>(values.size());
  double power = 0, window_power = 0;
  for (std::size_t i = 0; i < values.size(); ++i) window_power += std::pow(std::sin(std::numbers::pi * i / n), 4) / n;
  for (int k = static_cast<int>(std::ceil(kLowest * n * dt)); k <= kHighest * n * dt && k <= n / 2; ++k) {
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      sum += std::pow(std::sin(std::numbers::pi * i / n), 2) * values[i] *
             std::polar(1.0, -2 * std::numbers::pi * k * static_cast<double>(i) / n);
    power += (2 * k < n ? 2 : 1) * std::norm(sum) / (n * n);
  }
  return std::sqrt(power / window_power);
}

}  // namespace

std::vector<SlideTick> slide(PressRig& rig, const SurfacePath& path, double radius, double depth) {
  const SurfacePlace& first = path.places.front();
  rig.start(centre_at(first, radius, kAbove * radius));
  for (double at = kAbove * radius; at < depth; at += kSlideSpeed * rig.dt()) rig.press(centre_at(first, radius, at));
  for (int i = 0; i < kRest; ++i) rig.press(centre_at(first, radius, depth));
  std::vector<SlideTick> ticks;
  Vector3d before = centre_at(first, radius, depth);
  for (std::size_t i = 1; i < path.places.size(); ++i) {
    const SurfacePlace& place = path.places[i];
    const Vector3d centre = centre_at(place, radius, depth);
    rig.press(centre);
    const Vector3d on_tool = -rig.force(), motion = (centre - before).normalized();
    const Vector3d& pressed = rig.haptic().press(0);
    const Vector3d tangential = on_tool - on_tool.dot(pressed) * pressed;
    ticks.push_back({path.at(i), on_tool.norm(), tangential.dot(motion)});
    before = centre;
  }
  return ticks;
}

std::vector<double> press_places(PressRig& rig, std::span<const SurfacePlace> places, double radius, double depth) {
  std::vector<double> forces;
  for (const SurfacePlace& place : places) {
    for (double at = kAbove * radius; at < depth; at += 0.01 * radius) rig.press(centre_at(place, radius, at));
    for (int i = 0; i < kRest; ++i) rig.press(centre_at(place, radius, depth));
    forces.push_back(rig.force().dot(place.inward));
    for (double at = depth; at > kAbove * radius; at -= 0.05 * radius) rig.press(centre_at(place, radius, at));
  }
  return forces;
}

SlideMeasures measure_slide(std::span<const SlideTick> ticks, std::span<const double> trend, double dt) {
  const auto begin = static_cast<std::size_t>(
      std::ranges::find_if(ticks, [](const SlideTick& t) { return t.path >= 0; }) - ticks.begin());
  ticks = ticks.subspan(begin);
  trend = trend.subspan(begin);
  const auto count = static_cast<double>(ticks.size());
  SlideMeasures of;
  double among = 0, of_trend = 0;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    of.mean += ticks[i].force / count;
    among += ticks[i].force * trend[i];
    of_trend += trend[i] * trend[i];
    of.turn += ticks[i].tangential > kPushed * ticks[i].force;
    if (i > 0) of.jump = std::max(of.jump, std::abs(ticks[i].force - ticks[i - 1].force));
  }
  std::vector<double> about;
  for (std::size_t i = 0; i < ticks.size(); ++i) about.push_back(ticks[i].force - among / of_trend * trend[i]);
  of.ripple = std::sqrt(std::inner_product(about.begin(), about.end(), about.begin(), 0.0) / count) / of.mean;
  of.jump /= of.mean;
  of.turn /= count;
  of.buzz = band(about, dt) / of.mean;
  return of;
}

std::vector<double> line_through(std::span<const SlideTick> ticks) {
  double count = 0, path = 0, force = 0, squares = 0, products = 0;
  for (const SlideTick& t : ticks) {
    if (t.path < 0) continue;
    ++count;
    path += t.path;
    force += t.force;
    squares += t.path * t.path;
    products += t.path * t.force;
  }
  const double slope = (count * products - path * force) / (count * squares - path * path);
  std::vector<double> line;
  for (const SlideTick& t : ticks) line.push_back((force + slope * (count * t.path - path)) / count);
  return line;
}

double spread_of(std::span<const double> values) {
  const auto [least, most] = std::ranges::minmax(values);
  return (most - least) * static_cast<double>(values.size()) / std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace palpate
