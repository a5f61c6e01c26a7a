// What the hands feel in an example while its tissue misses ticks: the script pinches, cuts and pulls as if it did not.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "common/scene/ensure_archive.hpp"
#include "common/scene/scene.hpp"
#include "tests/sanitized.hpp"
#include "tools/rig/scripted_tools.hpp"
#include "tools/rig/two_nodes.hpp"

namespace palpate {
namespace {

constexpr int kTools = 2;
constexpr double kSmooth = 0.035;  // [N] in a tick, where the tissue misses none: half as much again as it is

/// [N] of each tool the largest force, and its largest change in a tick.
struct FeltByTools {
  std::array<double, kTools> largest{}, change{};
};

class MissedTicksInHepatectomy : public ::testing::Test {
 protected:
  template <class Missed>
  FeltByTools feel(Missed&& missed) {
    ScriptedTools tools(scene_);
    TwoNodes nodes(scene_, archives_);
    nodes.start(tools.at(0));
    FeltByTools felt;
    std::array<Eigen::Vector3d, kTools> before;
    before.fill(Eigen::Vector3d::Zero());
    const double dt = 1 / scene_.rates.haptic_hz;
    for (int k = 1; k * dt < tools.duration(); ++k) {
      missed(k) ? nodes.stop_tissue() : nodes.continue_tissue();
      nodes.step(tools.at(k * dt));
      for (int t = 0; t < kTools; ++t) {
        const Eigen::Vector3d force = nodes.force(t);
        felt.largest[t] = std::max(felt.largest[t], force.norm());
        felt.change[t] = std::max(felt.change[t], (force - before[t]).norm());
        before[t] = force;
      }
    }
    return felt;
  }

  const Scene scene_ = load_scene(PALPATE_SOURCE_DIR "/scenes/hepatectomy.toml");
  const std::vector<Archive> archives_ = load_or_precompute(scene_, ArchivePart::surface);
};

TEST_F(MissedTicksInHepatectomy, NoStaleForceStands) {
  if (testing::kSanitized) GTEST_SKIP() << "minutes long";
  const FeltByTools undisturbed = feel([](int) { return false; });
  for (int t = 0; t < kTools; ++t) EXPECT_LT(undisturbed.change[t], kSmooth) << t;
  for (const int longest : {10, 60}) {
    std::mt19937 random(longest);
    int until = 0;
    const FeltByTools felt = feel([&](int k) {
      if (k >= until && random() % (2 * longest) == 0) until = k + 1 + static_cast<int>(random() % longest);
      return k < until;
    });
    for (int t = 0; t < kTools; ++t) {
      std::printf("up to %d ticks missed, tool %d: %.3f N, %.3f N undisturbed; by %.3f N in a tick, %.3f N\n", longest,
                  t, felt.largest[t], undisturbed.largest[t], felt.change[t], undisturbed.change[t]);
      EXPECT_LE(felt.largest[t], 1.1 * undisturbed.largest[t]) << longest;
      EXPECT_LE(felt.change[t], scene_.tools[t].max_force_rate / scene_.rates.haptic_hz * (1 + 1e-9)) << longest;
    }
  }
}

}  // namespace
}  // namespace palpate
