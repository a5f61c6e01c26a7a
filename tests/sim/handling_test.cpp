#include "common/sim/handling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 1e-3;

/// Leads a tip by place(t) [m] for so long, with force(t) [N] along z.
template <class Place, class Force>
HandlingFigures figures_of(double seconds, const Place& place, const Force& force, double begin = 0) {
  Handling handling;
  for (int i = 0; i <= std::lround(seconds / kStep); ++i) {
    const double t = i * kStep;
    handling.look(begin + t, place(t), Vector3d(0, 0, force(t)));
  }
  return handling.figures();
}

double no_force(double) {
  return 0;
}

TEST(Handling, ACircleIsAsLongAsItIsAndJerksAsItsThirdDerivative) {
  constexpr double radius = 0.05, turns_per_s = 0.5, omega = 2 * std::numbers::pi * turns_per_s;
  const auto circle = [&](double t) { return Vector3d(radius * std::cos(omega * t), radius * std::sin(omega * t), 0); };
  const HandlingFigures f = figures_of(4, circle, no_force);
  EXPECT_NEAR(f.seconds, 4, 1e-9);
  EXPECT_NEAR(f.path, 2 * 2 * std::numbers::pi * radius, 0.01 * f.path);  // chords, the last of them not made
  EXPECT_NEAR(f.jerk, radius * std::pow(omega, 3), 0.01 * f.jerk);
  EXPECT_NEAR(f.economy, 0, 0.01);  // it ends where it began
  EXPECT_EQ(f.touches, 0);
  EXPECT_EQ(f.mean_force, 0);
}

TEST(Handling, AStraightWayIsEconomicalAndADetourIsNot) {
  const auto straight = [](double t) { return Vector3d(0.1 * t, 0, 0); };
  EXPECT_NEAR(figures_of(1, straight, no_force).economy, 1, 1e-9);
  const auto corner = [](double t) { return t < 1 ? Vector3d(0.1 * t, 0, 0) : Vector3d(0.1, 0.1 * (t - 1), 0); };
  EXPECT_NEAR(figures_of(2, corner, no_force).economy, std::numbers::sqrt2 / 2, 0.01);
}

// Down and up again: without the touch, the way would count as a detour.
TEST(Handling, WhatATouchAsksForIsNoDetour) {
  const auto down_and_up = [](double t) { return Vector3d(0, 0, -0.1 * (t < 1 ? t : 2 - t)); };
  const auto pressed = [](double t) { return std::abs(t - 1) < 0.2 ? 0.5 : 0.0; };
  EXPECT_LT(figures_of(2, down_and_up, no_force).economy, 0.02);
  EXPECT_GT(figures_of(2, down_and_up, pressed).economy, 0.9);
}

// As a log has it, whose clock has run for long.
TEST(Handling, TheTimeAtWhichItBeginsDoesNotCount) {
  const auto down_and_up = [](double t) { return Vector3d(0.05 * t * t, 0, -0.1 * (t < 1 ? t : 2 - t)); };
  for (int touched = 100; touched < 140; ++touched) {  // until which step, since rounding is chance
    const auto pressed = [&](double t) { return std::lround(t / kStep) < touched ? 0.5 : 0.0; };
    EXPECT_NEAR(figures_of(2, down_and_up, pressed, 54321.123456789).economy,
                figures_of(2, down_and_up, pressed).economy, 1e-9);
  }
}

TEST(Handling, ForcesAreCountedWhereThereAreAny) {
  const auto at_rest = [](double) { return Vector3d(Vector3d::Zero()); };
  // Two touches; the first is interrupted for 20 ms.
  const auto pressed = [](double t) {
    const bool first = t >= 0.1 && t < 0.3 && !(t >= 0.2 && t < 0.22), second = t >= 0.5 && t < 0.6;
    return first ? 0.2 : second ? 0.8 : 0.0;
  };
  const HandlingFigures f = figures_of(1, at_rest, pressed);
  EXPECT_EQ(f.touches, 2);
  EXPECT_NEAR(f.touching, 0.28, 2e-3);
  EXPECT_NEAR(f.impulse, 0.18 * 0.2 + 0.1 * 0.8, 1e-3);
  EXPECT_NEAR(f.mean_force, f.impulse / f.touching, 1e-12);
  EXPECT_EQ(f.max_force, 0.8);
  EXPECT_EQ(f.max_change, 0.8);
  EXPECT_EQ(f.path, 0);
  EXPECT_EQ(f.economy, 1);
}

}  // namespace
}  // namespace palpate
