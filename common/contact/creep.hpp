#pragma once
#include <array>
#include <span>
#include <vector>

#include "common/fem/relaxation_spec.hpp"

namespace palpate {

/// One retardation of the compliance of a body that relaxes: under a force that stays it gives way by
///   C (1 + sum of gain (1 - exp(-t / time))),
/// C being the compliance of the archive, which is that of a fast press.
struct CreepTerm {
  double time;  ///< [s]
  double gain;  ///< [1]
};

/// The creep that goes with a relaxation: product of the two Laplace transforms s E(s) / E0 and s J(s) is 1
/// (correspondence principle, Christensen 1982 sec. 2.4). The retardation times are where
///   1 - sum of g / (1 - tau / theta) = 0,
/// one between each tau and the next and one beyond the last.
std::vector<CreepTerm> creep_terms(const Relaxation& relaxation);

/// One step of creep in closed form. Displacements are u = C (f + sum of gain s), where each s follows the force
/// behind: ds/dt = (f - s) / time. For a force that changes linearly within the step,
///   s <- keep s + old f_before + fresh f_now.
class CreepStep {
 public:
  struct Term {
    double gain, keep, old, fresh;
  };

  /// `dt` [s] of a step.
  CreepStep(const Relaxation& relaxation, double dt);

  std::span<const Term> terms() const { return std::span(terms_).first(count_); }
  /// [1] Compliance to the force that a step brings, as a multiple of C: 1 + sum of gain fresh.
  double instant() const { return instant_; }

 private:
  std::array<Term, Relaxation::kMaxTerms> terms_{};
  std::size_t count_ = 0;
  double instant_ = 1;
};

}  // namespace palpate
