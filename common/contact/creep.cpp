#include "common/contact/creep.hpp"

#include <cmath>

namespace palpate {
namespace {

// 1 - sum of g / (1 - y tau): falls with y = 1 / theta from each pole to the next.
double rest_of(const Relaxation& r, double y) {
  double rest = 1;
  for (std::size_t i = 0; i < r.times.size(); ++i) rest -= r.shares[i] / (1 - y * r.times[i]);
  return rest;
}

// Its only root between two poles, or 0 and the first; bisection to the last bit.
double root_between(const Relaxation& r, double low, double high) {
  while (true) {
    const double middle = low + 0.5 * (high - low);
    if (middle <= low || middle >= high) return middle;
    (rest_of(r, middle) > 0 ? low : high) = middle;
  }
}

// Residue of 1 / (s E) at s = -1 / theta.
double gain_at(const Relaxation& r, double theta) {
  double slope = 0;
  for (std::size_t i = 0; i < r.times.size(); ++i) {
    const double part = 1 - r.times[i] / theta;
    slope += r.shares[i] * r.times[i] / (part * part);
  }
  return theta / slope;
}

}  // namespace

std::vector<CreepTerm> creep_terms(const Relaxation& relaxation) {
  std::vector<CreepTerm> terms;
  for (std::size_t i = 0; i < relaxation.times.size(); ++i) {
    const bool last = i + 1 == relaxation.times.size();
    const double low = last ? 0 : 1 / relaxation.times[i + 1];
    const double theta = 1 / root_between(relaxation, low, 1 / relaxation.times[i]);
    terms.push_back({theta, gain_at(relaxation, theta)});
  }
  return terms;
}

CreepStep::CreepStep(const Relaxation& relaxation, double dt) {
  for (const CreepTerm& term : creep_terms(relaxation)) {
    const double steps = dt / term.time, keep = std::exp(-steps);
    const double mean = -std::expm1(-steps) / steps;  // of what is left within the step
    terms_[count_++] = {.gain = term.gain, .keep = keep, .old = mean - keep, .fresh = 1 - mean};
    instant_ += term.gain * (1 - mean);
  }
}

}  // namespace palpate
