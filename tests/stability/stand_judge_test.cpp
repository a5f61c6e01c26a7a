#include "tools/stability/stand_judge.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/stability/moving_press.hpp"

/// Each bound is met by a tissue that stands, and missed by one fault.
namespace palpate::stability {
namespace {

struct Standing {
  double offset = 0, chatter = 0, alternation = 0, gained = 0, reach = 0.001;
  Eigen::Vector3d along = Eigen::Vector3d::UnitZ();  ///< the chatter and what turns round
};

/// A press to 2 N that is done with half a joule of work, and a second of standing.
Result judged(const Standing& s) {
  StandJudge judge;
  const Eigen::Vector3d press = Eigen::Vector3d::UnitZ();
  for (int i = 0; i < 100; ++i) judge.look(0.02 * i * press, 0.005, 0.005 * (i + 1), s.reach);
  for (int i = 0; i < 1000; ++i) {
    const double swing = s.chatter * std::sqrt(2) * std::sin(0.1 * i) + s.alternation * (i % 2 ? 1 : -1);
    judge.look(2 * ((1 + s.offset) * press + swing * s.along), 0, 0.5 * (1 + s.gained), s.reach);
  }
  return judge.result(2, press, 0.1);
}

TEST(StandJudge, IsContentWithTissueThatStands) {
  const Result r = judged({});
  EXPECT_EQ(r.outcome, Outcome::stable) << r.note;
  EXPECT_NEAR(r.max_force, 2, 1e-12);
  EXPECT_NEAR(r.energy_growth, 0, 1e-12);
}

TEST(StandJudge, NamesTheBoundThatIsMissed) {
  const std::pair<Standing, const char*> faults[] = {
      {{.offset = 0.03}, "off the static answer"},
      {{.offset = -0.03}, "off the static answer"},
      {{.chatter = 0.006}, "chatter"},
      {{.alternation = 0.003}, "alternation"},
      {{.chatter = 0.006, .along = Eigen::Vector3d::UnitX()}, "chatter"},
      {{.alternation = 0.003, .along = Eigen::Vector3d::UnitY()}, "alternation"},
      {{.gained = 0.03}, "energy beyond the work"},
      {{.reach = 0.06}, "reach over the diagonal"},
      {{.offset = NAN}, "off the static answer"},
      {{.gained = NAN}, "energy beyond the work"},
      {{.reach = NAN}, "reach over the diagonal"}};
  for (const auto& [fault, word] : faults) {
    const Result r = judged(fault);
    EXPECT_EQ(r.outcome, Outcome::failed) << word;
    EXPECT_NE(r.note.find(word), std::string::npos) << r.note;
  }
}

TEST(StandJudge, IsContentJustWithinTheBounds) {
  for (const Standing& s : {Standing{.offset = 0.019}, Standing{.chatter = 0.0045}, Standing{.alternation = 0.0015},
                            Standing{.gained = 0.015}, Standing{.reach = 0.045}})
    EXPECT_EQ(judged(s).outcome, Outcome::stable) << judged(s).note;
}

/// The force over E of a frictionless press is one number, however stiff the tissue.
TEST(MovingPress, StandsAtTheStaticAnswerAtAnyStiffness) {
  const double soft = press_moving({.young = 5e3}).max_force / 5e3;
  for (const double young : {2e5, 5e6, 1e8}) {
    const Result r = press_moving({.young = young});
    EXPECT_EQ(r.outcome, Outcome::stable) << young << ": " << r.note;
    EXPECT_NEAR(r.max_force / young, soft, 0.005 * soft) << young;
  }
}

}  // namespace
}  // namespace palpate::stability
