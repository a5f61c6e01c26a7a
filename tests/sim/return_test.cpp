// What the hand feels when the deformation node is stopped, or dies and comes back, while a tool presses and slides, or
// cuts.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "common/devices/device.hpp"
#include "common/scene/ensure_archive.hpp"
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

  /// The same press and slide `kHaste` times as fast, of a tissue that gets on with one tick of so many alone. The tool
  /// has been there for a while.
  std::vector<double> feel_slow(int of) const {
    constexpr int kBefore = 1500, kHaste = 4;
    TwoNodes nodes(scene_.scene, scene_.archives);
    nodes.start(std::array{at(0)});
    std::vector<double> felt;
    for (int k = -kBefore; k < 1500; ++k) {
      k % of == 0 ? nodes.continue_tissue() : nodes.stop_tissue();
      nodes.step(std::array{at(kHaste * std::max(k, 0))});
      if (k >= 0) felt.push_back(nodes.force(0).norm());
    }
    return felt;
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

TEST_F(InterruptedPress, IsFeltAllTheWayOfATissueTooSlowForItsTicks) {
  const std::vector<double> undisturbed = feel_slow(1);
  const double largest = std::ranges::max(undisturbed);
  struct Bound {
    int of;
    double off, fall;  ///< of the largest force
  };
  for (const auto [of, most_off, most_fall] : {Bound{2, 0.05, 0.01}, Bound{4, 0.12, 0.04}}) {
    SCOPED_TRACE(fmt::format("one tick of {}", of));
    const std::vector<double> felt = feel_slow(of);
    double off = 0, rise = 0, fall = 0;
    for (std::size_t k = 1; k < felt.size(); ++k) {
      off = std::max(off, std::abs(felt[k] - undisturbed[k]));
      rise = std::max(rise, felt[k] - felt[k - 1]);
      fall = std::max(fall, felt[k - 1] - felt[k]);
    }
    fmt::print("{:.4f} N at most, {:.4f} N off, falls by {:.4f} N\n", largest, off, fall);
    EXPECT_LT(off, most_off * largest);
    EXPECT_LT(fall, most_fall * largest);
    EXPECT_LE(rise, 1e-3 * scene_.scene.tools[0].max_force_rate * (1 + 1e-9));
  }
}

/// An example scene's script goes on while one of the nodes is away.
class InterruptedScript : public ::testing::Test {
 protected:
  enum class Victim { nobody, tissue, haptic };
  /// One node is gone between two ticks.
  struct Death {
    Victim victim = Victim::nobody;
    int first = -1, back = -1;
  };
  struct Felt {
    double largest = 0, rise = 0, change = 0;  ///< [N]; in a tick of the size, and as vectors
  };
  /// A scene with its script's motion.
  struct Played {
    explicit Played(const std::string& name) : scene(load_scene(PALPATE_SOURCE_DIR "/scenes/" + name + ".toml")) {
      device = make_devices(scene.tools, scene.rates.haptic_hz);
    }
    std::vector<ToolDofs> at(int k) const {
      std::vector<ToolDofs> dofs;
      for (const auto& d : device) dofs.push_back(d->read(1e-3 * k).dofs);
      return dofs;
    }
    Scene scene;
    std::vector<Archive> archives = load_or_precompute(scene, ArchivePart::surface);
    std::vector<std::unique_ptr<Device>> device;
  };

  /// What the hand on the scene's last tool feels up to a tick; in the tick of a death nothing is counted.
  static Felt feel(const Played& played, int end, const Death& death) {
    TwoNodes nodes(played.scene, played.archives);
    nodes.start(played.at(0));
    const int last = static_cast<int>(played.scene.tools.size()) - 1;
    Felt felt;
    Eigen::Vector3d before = Eigen::Vector3d::Zero();
    for (int k = 1; k < end; ++k) {
      const bool tissue = death.victim == Victim::tissue;
      if (k == death.first) tissue ? nodes.kill_tissue() : nodes.kill_haptic();
      if (k == death.back) tissue ? nodes.restart_tissue() : nodes.restart_haptic(played.at(k));
      nodes.step(played.at(k));
      const Eigen::Vector3d now = nodes.force(last);
      felt.largest = std::max(felt.largest, now.norm());
      if (k != death.first) {
        felt.rise = std::max(felt.rise, now.norm() - before.norm());
        felt.change = std::max(felt.change, (now - before).norm());
      }
      before = now;
    }
    return felt;
  }

  static void expect_no_kick(const Played& played, int end, std::initializer_list<Death> deaths) {
    const double undisturbed = feel(played, end, {}).largest;
    for (const Death& death : deaths) {
      SCOPED_TRACE(fmt::format("ticks {} to {}", death.first, death.back));
      const Felt felt = feel(played, end, death);
      EXPECT_LT(felt.largest, 1.1 * undisturbed);
      EXPECT_LT(felt.rise, 0.1);
      EXPECT_LT(felt.change, 0.1);
    }
  }
};

/// A tool that another haptic node puts into the tissue, which swings since the first one's has gone.
class PutIntoTissue : public InterruptedScript {};

TEST_F(PutIntoTissue, IsNoKickWhereAHapticNodeComesBack) {
  expect_no_kick(Played("block_partial"), 5500, {{Victim::haptic, 3970, 4369}, {Victim::haptic, 3800, 4200}});
  expect_no_kick(Played("cylinder_hybrid"), 8000, {{Victim::haptic, 4325, 6583}});
}

/// What a scalpel should have cut meanwhile is not.
class MissedCut : public InterruptedScript {};

TEST_F(MissedCut, IsNoKickInAPlate) {
  // In the second the scalpel comes into its old slot with its shaft against what was left uncut, and presses on.
  expect_no_kick(Played("plate_cut"), 8000,
                 {{Victim::tissue, 5757, 5788}, {Victim::tissue, 3000, 3900}, {Victim::haptic, 2446, 4378}});
}

TEST_F(MissedCut, IsNoKickBetweenFlapsThatForcepsHadDrawnApart) {
  expect_no_kick(Played("hepatectomy"), 6500, {{Victim::tissue, 4495, 4732}, {Victim::haptic, 3669, 5601}});
}

// It swings since the tool that pressed it was gone, and would since another was put into it: 1.14 times the
// undisturbed force in both.
TEST_F(InterruptedScript, IsNoKickInTissueThatSwings) {
  expect_no_kick(Played("cylinder_hybrid"), 9000, {{Victim::haptic, 6870, 7331}, {Victim::haptic, 5548, 7356}});
}

// A pedal that is down cuts from the first tick on, and nothing while the tissue comes to rest.
TEST(ReturnToATool, CutsNothingWhileTheTissueComesToRestAroundIt) {
  const testing::PlayedScene played = testing::cut_block();
  DynamicWorld world(played.scene, played.archives);
  const ToolDofs dofs = tip_at(played.scene.tools[0], {-0.01, 0, 0.033});
  ToolState state{.tool = 0, .run = 1, .yaw = dofs.yaw, .pitch = dofs.pitch, .depth = dofs.depth, .roll = dofs.roll};
  state.pedal = 1;
  const auto hear = [&] {
    ++state.step;
    ASSERT_TRUE(world.take(state));
  };
  hear();
  while (!world.settle()) {
  }
  EXPECT_TRUE(world.organ(0).passes(0)) << "in the midst of a cut";
  EXPECT_TRUE(world.organ(0).removed().empty());
  for (int i = 0; i < 20; ++i) hear(), world.tick();
  EXPECT_FALSE(world.organ(0).removed().empty());
  EXPECT_TRUE(world.organ(0).contacts().empty());
}

}  // namespace
}  // namespace palpate
