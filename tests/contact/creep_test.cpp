#include "common/contact/creep.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace palpate {
namespace {

const Relaxation kSeries[] = {
    {{0.3}, {0.4}},
    {{0.5, 50}, {0.450, 0.365}},  // brain, Miller & Chinzei 1997
    {{1e-4, 0.01, 0.011, 2, 900}, {0.05, 0.2, 0.1, 0.3, 0.34}},
    {{1, 2, 3, 4, 5, 6, 7, 8}, {0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1}},
};

double rest_of(const Relaxation& r) {
  return 1 - std::accumulate(r.shares.begin(), r.shares.end(), 0.0);
}

TEST(Creep, IsWhatUndoesTheRelaxation) {
  for (const Relaxation& r : kSeries)
    for (double s = 1e-5; s < 1e6; s *= 3) {  // of the Laplace transforms
      double relaxed = 1, crept = 1;
      for (std::size_t i = 0; i < r.times.size(); ++i) relaxed -= r.shares[i] / (1 + s * r.times[i]);
      for (const CreepTerm& term : creep_terms(r)) crept += term.gain / (1 + s * term.time);
      EXPECT_NEAR(relaxed * crept, 1, 1e-9) << s;
    }
}

TEST(Creep, EachRetardationLiesBeyondItsRelaxationAndBeforeTheNext) {
  for (const Relaxation& r : kSeries) {
    const std::vector<CreepTerm> terms = creep_terms(r);
    ASSERT_EQ(terms.size(), r.times.size());
    double all = 1;
    for (std::size_t k = 0; k < terms.size(); ++k) {
      EXPECT_GT(terms[k].time, r.times[k]);
      if (k + 1 < terms.size()) {
        EXPECT_LT(terms[k].time, r.times[k + 1]);
      }
      EXPECT_GT(terms[k].gain, 0);
      all += terms[k].gain;
    }
    EXPECT_NEAR(all * rest_of(r), 1, 1e-9) << "in the end it gives way as tissue of the modulus that is left";
  }
}

TEST(Creep, OfOneTermIsKnownInClosedForm) {
  const std::vector<CreepTerm> terms = creep_terms({{0.3}, {0.4}});
  EXPECT_NEAR(terms[0].time, 0.3 / 0.6, 1e-14);
  EXPECT_NEAR(terms[0].gain, 0.4 / 0.6, 1e-14);
}

// f = t gives u = t + sum of gain (t - theta (1 - exp(-t / theta))).
TEST(Creep, StepsOfAnyLengthAreExactForAForceThatGrowsEvenly) {
  for (const Relaxation& r : kSeries)
    for (const double dt : {1e-3, 0.1, 7.0}) {
      const CreepStep step(r, dt);
      std::vector<double> lag(r.times.size(), 0.0);
      for (int n = 1; n <= 50; ++n) {
        const double t = n * dt;
        double u = t, expected = t;
        for (std::size_t k = 0; k < lag.size(); ++k) {
          const CreepStep::Term& term = step.terms()[k];
          lag[k] = term.keep * lag[k] + term.old * (t - dt) + term.fresh * t;
          u += term.gain * lag[k];
        }
        for (const CreepTerm& term : creep_terms(r))
          expected += term.gain * (t + term.time * std::expm1(-t / term.time));
        ASSERT_NEAR(u, expected, 1e-9 * expected) << n;
      }
    }
}

TEST(Creep, TimesFarFromTheStepAreThoseOfElasticTissue) {
  EXPECT_NEAR(CreepStep({{1e9}, {0.5}}, 1e-3).instant(), 1, 1e-9);
  EXPECT_NEAR(CreepStep({{1e-9}, {0.5}}, 1e-3).instant(), 2, 1e-5);
}

}  // namespace
}  // namespace palpate
