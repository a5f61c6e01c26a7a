#include "common/models/modal_shell/modal_newmark.hpp"

namespace palpate {

std::vector<double> modal_damping(std::span<const double> omega, double ratio, double mass_damping) {
  std::vector<double> damping;
  for (double w : omega) damping.push_back(mass_damping > 0 ? mass_damping : 2 * ratio * w);
  return damping;
}

ModalConstants make_modal_constants(std::span<const double> omega, std::span<const double> damping, double h) {
  ModalConstants constants;
  constants.h = h;
  for (std::size_t i = 0; i < omega.size(); ++i) {
    const double w2 = omega[i] * omega[i], d = damping[i];
    const double inverse = 4 / (w2 + 2 * d / h + 4 / (h * h));
    constants.omega2.push_back(w2);
    constants.damping.push_back(d);
    constants.inverse.push_back(inverse);
    constants.carry.push_back(inverse * (1 / h - d / 2 - w2 * h / 4));
    constants.pull.push_back(-inverse * w2);
  }
  return constants;
}

void free_motion(const ModalConstants& constants, const double* x, const double* v, const double* force, double* y) {
  const double *carry = constants.carry.data(), *pull = constants.pull.data(), *inverse = constants.inverse.data();
  for (int i = 0; i < constants.modes(); ++i) y[i] = carry[i] * v[i] + pull[i] * x[i] + inverse[i] * force[i];
}

void advance(const ModalConstants& constants, double* x, double* v, const double* y) {
  for (int i = 0; i < constants.modes(); ++i) {
    const double next = y[i] / constants.h;
    x[i] += constants.h / 2 * (v[i] + next);
    v[i] = next;
  }
}

ModalNewmark::ModalNewmark(std::span<const double> omega, std::span<const double> damping, double h)
    : damping_(damping.begin(), damping.end()), h_(h), x_(omega.size()), v_(omega.size()), a_(omega.size()) {
  for (double w : omega) omega2_.push_back(w * w);
}

void ModalNewmark::start(std::span<const double> x, std::span<const double> v, std::span<const double> force) {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    x_[i] = x[i];
    v_[i] = v[i];
    a_[i] = force[i] - damping_[i] * v[i] - omega2_[i] * x[i];
  }
}

void ModalNewmark::step(std::span<const double> force) {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double a0 = (4 + 2 * damping_[i] * h_) / (h_ * h_);
    const double load = force[i] + a0 * x_[i] + (4 / h_ + damping_[i]) * v_[i] + a_[i];
    const double x = load / (omega2_[i] + a0);
    const double a = 4 / (h_ * h_) * (x - x_[i] - h_ * v_[i]) - a_[i];
    v_[i] += h_ / 2 * (a_[i] + a);
    x_[i] = x;
    a_[i] = a;
  }
}

}  // namespace palpate
