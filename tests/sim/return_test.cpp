// What the hand feels when the deformation node is stopped, or dies and comes back, while a tool presses and slides.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "common/fem/dense.hpp"
#include "tests/sim/played_scenes.hpp"
#include "tools/rig/two_nodes.hpp"

namespace palpate {
namespace {

class InterruptedPress : public ::testing::Test {
 protected:
  struct Felt {
    double largest = 0, rise = 0;  ///< [N]; of the size in a tick
    double end = 0;                ///< [N]
  };

  InterruptedPress() { set_linear_algebra_threads(1); }

  /// From 0 to 1 without a jerk at either end.
  static double eased(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3 - 2 * t);
  }
  /// The tip goes 4 mm into the block's top, then 10 mm aside.
  ToolDofs at(int k) const {
    const double down = eased(k / 600.0), aside = eased((k - 600) / 1500.0);
    return tip_at(scene_.scene.tools[0], {-0.005 + 0.01 * aside, 0.002, 0.041 - 0.009 * down});
  }

  /// A node is gone for `away` ticks from tick `first` on.
  template <class Gone, class Back>
  Felt feel(int first, int away, Gone&& gone, Back&& back) const {
    TwoNodes nodes(scene_.scene, scene_.archives);
    nodes.start(std::array{at(0)});
    Felt felt;
    double before = 0;
    for (int k = 0; k < 3500; ++k) {
      if (k == first) gone(nodes);
      if (k == first + away) back(nodes);
      nodes.step(std::array{at(k)});
      felt.end = nodes.force(0).norm();
      felt.largest = std::max(felt.largest, felt.end);
      felt.rise = std::max(felt.rise, felt.end - before);
      before = felt.end;
    }
    return felt;
  }
  /// For so many ticks, from any moment of the press on.
  template <class Gone, class Back>
  void expect_no_kicks(std::initializer_list<int> spans, Gone&& gone, Back&& back) const {
    const auto nothing = [](auto&) {};
    const Felt undisturbed = feel(-1, 0, nothing, nothing);
    for (const int away : spans)
      for (const int first : {200, 450, 800, 1200, 1700, 2400}) {
        SCOPED_TRACE(fmt::format("{} ticks from {} on", away, first));
        expect_no_kick(feel(first, away, gone, back), undisturbed);
      }
  }
  void expect_no_kick(const Felt& felt, const Felt& undisturbed) const {
    EXPECT_LT(felt.largest, 1.1 * undisturbed.largest);
    EXPECT_LE(felt.rise, 1e-3 * scene_.scene.tools[0].max_force_rate * (1 + 1e-9));
    EXPECT_NEAR(felt.end, undisturbed.end, 0.15 * undisturbed.end);  // friction remembers the way there
  }

  const testing::PlayedScene scene_ = testing::cut_block();
};

TEST_F(InterruptedPress, IsNoKickWhenTheTissueDiesAndComesBackOrAnotherTakesOverAtOnce) {
  expect_no_kicks(
      {30, 700}, [](auto& t) { t.kill_tissue(); }, [](auto& t) { t.restart_tissue(); });
}

TEST_F(InterruptedPress, IsNoKickWhenTheTissueStopsForAWhile) {
  expect_no_kicks(
      {8, 30, 120, 400}, [](auto& t) { t.stop_tissue(); }, [](auto& t) { t.continue_tissue(); });
}

TEST_F(InterruptedPress, IsNoKickWhenTheHapticNodeDiesAndAnotherComesBack) {
  // The hand is where the script has it when the other one comes.
  const Felt undisturbed = feel(
      -1, 0, [](auto&) {}, [](auto&) {});
  for (const int away : {300, 900})
    for (const int first : {200, 450, 800, 1200, 1700, 2400}) {
      SCOPED_TRACE(fmt::format("{} ticks from {} on", away, first));
      const int back = first + away;
      expect_no_kick(
          feel(
              first, away, [](auto& t) { t.kill_haptic(); }, [&](auto& t) { t.restart_haptic(std::array{at(back)}); }),
          undisturbed);
    }
}

}  // namespace
}  // namespace palpate
