// Why ModalBody meets contacts at the step's end velocity: met in the end position, as in (J Phi K^^-1 Phi^T J^T + R +
// c) f = gap, the force of a tool that rests on a modal body alternates from step to step and the contact is lost again
// and again; met by h v(t+h) it settles.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "common/models/modal_shell/modal_newmark.hpp"

namespace palpate {
namespace {

constexpr int kModes = 50;
constexpr double kH = 1e-3, kToolCompliance = 1e-4;

/// A point of a body with fifty modes, lightly damped, that a tool presses in over 0.1 s and then holds.
struct PressedMode {
  std::vector<double> omega, at_point;
  double residual;

  explicit PressedMode(double residual) : residual(residual) {
    std::mt19937 random(2);
    std::normal_distribution<double> shape(0, 40);
    for (int m = 0; m < kModes; ++m) {
      omega.push_back(44 + 50.0 * m);
      at_point.push_back(shape(random) * std::exp(-m / 60.0));
    }
  }
  static double depth(int step) { return 0.002 * std::min(1.0, kH * step / 0.1); }
  double dot(std::span<const double> a) const {
    double sum = 0;
    for (int m = 0; m < kModes; ++m) sum += at_point[m] * a[m];
    return sum;
  }
};

struct Forces {
  double last = 0, max_change = 0;  ///< [N] of the last fifty steps
  int lost = 0;                     ///< steps without force, after the first twenty

  void enter(int step, int steps, double force) {
    if (step > steps - 50) max_change = std::max(max_change, std::abs(force - last));
    if (step > 20 && force == 0) ++lost;
    last = force;
  }
};

constexpr int kSteps = 400;

Forces meet_position(const PressedMode& body) {
  ModalNewmark newmark(body.omega, modal_damping(body.omega, 0.02, 0), kH);
  const std::vector<double> rest(kModes, 0.0), damping = modal_damping(body.omega, 0.02, 0);
  newmark.start(rest, rest, rest);
  double compliance = body.residual + kToolCompliance;
  for (int m = 0; m < kModes; ++m)
    compliance +=
        body.at_point[m] * body.at_point[m] / (body.omega[m] * body.omega[m] + 2 * damping[m] / kH + 4 / (kH * kH));
  Forces forces;
  for (int step = 1; step <= kSteps; ++step) {
    ModalNewmark free = newmark;
    free.step(rest);
    const double force = std::max(0.0, (PressedMode::depth(step) - body.dot(free.position())) / compliance);
    std::vector<double> load(kModes);
    for (int m = 0; m < kModes; ++m) load[m] = body.at_point[m] * force;
    newmark.step(load);
    forces.enter(step, kSteps, force);
  }
  return forces;
}

Forces meet_velocity(const PressedMode& body) {
  const ModalConstants constants = make_modal_constants(body.omega, modal_damping(body.omega, 0.02, 0), kH);
  std::vector<double> x(kModes), v(kModes), y(kModes), none(kModes);
  double compliance = body.residual + kToolCompliance;
  for (int m = 0; m < kModes; ++m) compliance += body.at_point[m] * body.at_point[m] * constants.inverse[m];
  Forces forces;
  for (int step = 1; step <= kSteps; ++step) {
    free_motion(constants, x.data(), v.data(), none.data(), y.data());
    const double force = std::max(0.0, (PressedMode::depth(step) - body.dot(x) - body.dot(y)) / compliance);
    for (int m = 0; m < kModes; ++m) y[m] += constants.inverse[m] * body.at_point[m] * force;
    advance(constants, x.data(), v.data(), y.data());
    forces.enter(step, kSteps, force);
  }
  return forces;
}

double static_force(const PressedMode& body) {
  double compliance = body.residual + kToolCompliance;
  for (int m = 0; m < kModes; ++m) compliance += std::pow(body.at_point[m] / body.omega[m], 2);
  return 0.002 / compliance;
}

TEST(ContactInNewmark, MetInTheEndPositionTheForceNeverSettles) {
  const PressedMode body(0);
  const Forces forces = meet_position(body);
  EXPECT_GT(forces.max_change, static_force(body));
  EXPECT_GT(forces.lost, 50);
}

TEST(ContactInNewmark, MetByTheEndVelocityItSettlesToTheStaticForce) {
  for (const double residual : {0.0, 2e-3}) {
    const PressedMode body(residual);
    const Forces forces = meet_velocity(body);
    EXPECT_LT(forces.max_change, 0.01 * static_force(body)) << residual;
    EXPECT_EQ(forces.lost, 0) << residual;
    EXPECT_NEAR(forces.last, static_force(body), 0.05 * static_force(body)) << residual;
  }
}

}  // namespace
}  // namespace palpate
