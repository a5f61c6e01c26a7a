// Contact with moving tissue, where it is stiff, soft, thin, small, heavy, light or far away.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <random>

#include "common/models/moving/tried_contact.hpp"
#include "tools/stability/moving_press.hpp"

namespace palpate::stability {
namespace {

constexpr int kCombinations = 500, kQuickCombinations = 30;
constexpr int kAveraged = 100, kQuickAveraged = 4;  // combinations of elements of averaged strain
constexpr int kShafts = 100, kQuickShafts = 12;     // combinations of level shafts; quickly those narrower than an edge
constexpr int kRims = 100, kQuickRims = 8;          // combinations of balls within a radius and a half of a rim
constexpr std::array kLongPoints{6, 14};            // seconds each
constexpr int kTelling = 106;     // fails if the patch follows each swing of the tissue; no quick one does
constexpr double kFromRim = 1.5;  // [1] of the radius
using Tried = TriedContact;

std::string words_of(const MovingPress& p) {
  return fmt::format("E {:.2g} Pa, cells {:.2g} x {:.2g} mm, R {:.2g} mm, friction {:g}, {}, {} {}", p.young,
                     1e3 * p.cell.x(), 1e3 * p.cell.z(), 1e3 * p.radius, p.friction, p.gesture, word_of(p.integrator),
                     word_of(p.precision));
}

/// Whether a tick takes less than some hundred steps.
bool makes_sense(const MovingPress& p) {
  const double step = 0.25 * p.cell.z() * std::sqrt(p.density / p.young);
  return 1e-3 / step < Tried::kMaxSteps;
}

/// Cells of a block that is wider than a ball by half.
Eigen::Vector3i cells_under(double radius, double cell) {
  const int across = std::max(4, 2 * static_cast<int>(std::ceil(1.5 * radius / cell)));
  return {across, across, across / 2};
}

/// Any values, each drawn from its range.
MovingPress drawn(std::mt19937& random) {
  const auto share = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  const auto between = [&](double a, double b) { return a * std::pow(b / a, share()); };
  const auto one_of = [&](auto list) { return list[std::min<std::size_t>(list.size() * share(), list.size() - 1)]; };
  MovingPress p;
  const double size = between(Tried::kMinCell, Tried::kMaxCell);
  p.cell = {size, size, size * one_of(std::array{1.0, 1.0, 0.3, 0.1})};
  p.young = between(Tried::kMinYoung, Tried::kMaxYoung);
  p.poisson = one_of(std::array{0.0, 0.3, Tried::kMaxPoisson});
  p.density = one_of(std::array{300.0, 1000.0, 3000.0});
  p.damping = one_of(std::array{5.0, 60.0});
  p.integrator = one_of(std::array{Integrator::rk4, Integrator::semi_implicit});
  p.precision = one_of(std::array{Precision::float32, Precision::float64});
  p.radius = size * between(Tried::kMinRadius, Tried::kMaxRadius);
  p.cells = cells_under(p.radius, size);
  p.depth = std::min(Tried::kMaxDepth * p.radius, 0.2 * p.cells.z() * p.cell.z());
  p.beside = {share() - 0.5, share() - 0.5};
  p.friction = one_of(std::array{0.0, 0.05, 0.3, Tried::kMaxFriction});
  p.gesture = one_of(std::array{"held", "tapped", "slid", "stabbed"});
  if (share() < 0.1) p.origin = {1e3, -2e3, 500};
  return p;
}

MovingPress any_press(std::mt19937& random) {
  MovingPress p = drawn(random);
  while (!makes_sense(p)) p = drawn(random);
  return p;
}

struct NamedPress {
  const char* parameter;
  std::string value;
  MovingPress press;
};

/// Those by which contact by nodes and facets was found unstable.
std::vector<NamedPress> table_presses(const Extent& extent) {
  std::vector<NamedPress> all;
  for (double e : extent.quick ? std::vector{5e6} : std::vector{2e5, 5e5, 1e6, 5e6})
    all.push_back({"E [Pa], 10 mm cells, R 5 mm", fmt::format("{:g}", e), {.young = e}});
  if (extent.quick) return all;
  for (double r : {0.005, 0.02})
    all.push_back(
        {"R [m], slab of 10 x 10 x 1 mm cells", fmt::format("{:g}", r), {.cell = {0.01, 0.01, 0.001}, .radius = r}});
  all.push_back({"film", "cells of 40 um", {.cell = {4e-5, 4e-5, 4e-5}, .radius = 2e-5, .depth = 8e-6}});
  return all;
}

std::vector<NamedPress> fixed_presses(const Extent& extent) {
  std::vector<NamedPress> all;
  for (double e : extent.quick ? std::vector{2e5, 5e6} : std::vector{1e2, 5e3, 2e5, 5e5, 1e6, 5e6, 1e8})
    all.push_back({"E [Pa], 10 mm cells, R 5 mm", fmt::format("{:g}", e), {.young = e}});
  for (double r : extent.quick ? std::vector{0.005} : std::vector{0.002, 0.005, 0.02})
    all.push_back({"R [m], slab of 10 x 10 x 1 mm cells",
                   fmt::format("{:g}", r),
                   {.cell = {0.01, 0.01, 0.001}, .radius = r, .depth = std::min(0.002, 0.4 * r)}});
  all.push_back({"film", "cells of 40 um", {.cell = {4e-5, 4e-5, 4e-5}, .radius = 2e-5, .depth = 8e-6}});
  all.push_back({"R over the edge [1]", "0.1", {.radius = 0.001, .depth = 3e-4}});
  all.push_back({"R over the edge [1]", "5", {.cells = cells_under(0.05, 0.01), .radius = 0.05, .depth = 0.005}});
  all.push_back({"distance from the origin [m]", "1e5", {.origin = {1e5, 0, 0}}});
  all.push_back({"elements", "corotational", {.depth = 2e-4, .corotational = true}});
  return all;
}

}  // namespace

std::vector<Point> moving_points(const Extent& extent) {
  std::vector<Point> points;
  const auto add = [&](const char* name, const char* parameter, const std::string& value, const MovingPress& p) {
    points.push_back({name, parameter, value, [p] { return press_moving(p); }, 300});
  };
  for (const auto& [parameter, value, press] : fixed_presses(extent)) add("moving contact", parameter, value, press);
  for (auto [parameter, value, press] : table_presses(extent)) {
    press.rule = ContactRule::barycentric;
    add("moving contact, by nodes", parameter, value, press);
  }
  std::mt19937 random(5);
  for (int i = 0; i < kCombinations; ++i) {
    const MovingPress p = any_press(random);
    const bool quick = i < kQuickCombinations ? std::ranges::count(kLongPoints, i) == 0 : i == kTelling;
    if (extent.quick && !quick) continue;
    add("moving contact, any", "combination", fmt::format("{}: {}", i, words_of(p)), p);
  }
  std::mt19937 of_averaged(6);
  for (int i = 0; i < (extent.quick ? kQuickAveraged : kAveraged); ++i) {
    MovingPress p = any_press(of_averaged);
    p.element = TetElement::nodal_strain;
    add("moving contact, averaged strain", "combination", fmt::format("{}: {}", i, words_of(p)), p);
  }
  std::mt19937 of_shafts(7);
  for (int i = 0; i < (extent.quick ? kQuickShafts : kShafts); ++i) {
    MovingPress p = any_press(of_shafts);
    p.shaft = true;
    if (extent.quick && p.radius > p.cell.x()) continue;
    add("moving contact, shafts", "combination", fmt::format("{}: {}", i, words_of(p)), p);
  }
  std::mt19937 of_rims(8);
  for (int i = 0; i < (extent.quick ? kQuickRims : kRims); ++i) {
    MovingPress p = any_press(of_rims);
    p.from_rim = std::uniform_real_distribution<double>(0, kFromRim)(of_rims);
    add("moving contact, at a rim", "combination", fmt::format("{}: {:.2g} R from it, {}", i, *p.from_rim, words_of(p)),
        p);
  }
  return points;
}

}  // namespace palpate::stability
