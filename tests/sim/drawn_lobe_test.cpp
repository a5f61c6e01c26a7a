// A hand takes the forceps, whose jaws hold the lobe, from its script and draws the lobe over the scalpel, which goes
// on by its own: the hand is pulled at as hard as it pulls, and what is cut is not thrown about.
#include <gtest/gtest.h>

#include <array>

#include "common/devices/device.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/scene.hpp"
#include "common/tool/motion_guard.hpp"
#include "tests/sanitized.hpp"
#include "tools/rig/two_nodes.hpp"

namespace palpate {
namespace {

constexpr double kDt = 1e-3;
constexpr int kSampleApart = 16;  // ticks: sixty samples a second
constexpr int kLateTicks = 4;     // that the tissue's models come late
constexpr double kEach = 0.25;    // [s] at each place

// As a page leads it that wants to press the organ elsewhere: out along the shaft, which the lobe holds back, and over.
constexpr std::array<std::array<double, 3>, 12> kPlaces{{{-0.03, 0.01, 0.134},  // yaw, pitch [rad], depth [m]
                                                         {0.06, -0.05, 0.138},
                                                         {0.04, -0.05, 0.138},
                                                         {0.06, -0.06, 0.138},
                                                         {0.06, -0.06, 0.138},
                                                         {0.06, -0.06, 0.138},
                                                         {0.07, -0.06, 0.138},
                                                         {0.47, -0.09, 0.138},
                                                         {0.13, -0.07, 0.138},
                                                         {0.16, -0.07, 0.138},
                                                         {0.25, -0.02, 0.135},
                                                         {0.26, 0, 0.135}}};

class DrawnLobe : public ::testing::Test {
 protected:
  struct Felt {
    std::array<double, 2> most{}, change{};  ///< [N] of forceps and scalpel, and in a tick
    double fastest = 0;                      ///< [m/s] of the tissue's nodes
    int refused = 0;                         ///< models
  };

  /// By the hand, from a time [s] on.
  Felt draw(double taken) {
    TwoNodes nodes(scene_, archives_);
    nodes.delay(kLateTicks);
    const auto devices = make_devices(scene_.tools, 1 / kDt, true);
    std::vector<MotionGuard> guards;
    std::vector<ToolDofs> dofs;
    for (std::size_t t = 0; t < devices.size(); ++t) {
      guards.emplace_back(scene_.tools[t].motion, kDt);
      dofs.push_back(devices[t]->read(0).dofs);
    }
    nodes.start(dofs);
    Felt felt;
    std::array<Eigen::Vector3d, 2> before{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    for (int k = 1; k * kDt < taken + kEach * kPlaces.size(); ++k) {
      if (k * kDt >= taken && k % kSampleApart == 0) {
        const auto& [yaw, pitch, depth] = kPlaces[static_cast<std::size_t>((k * kDt - taken) / kEach)];
        const ToolDofs led{.yaw = yaw, .pitch = pitch, .depth = depth, .grip = 0.05};
        devices[0]->put({led, static_cast<std::uint64_t>(k)});
      }
      for (std::size_t t = 0; t < devices.size(); ++t) {
        const DeviceSample sample = devices[t]->read(k * kDt);
        dofs[t] = guards[t].follow(sample.dofs, sample.seq);
      }
      nodes.step(dofs);
      for (int t = 0; t < 2; ++t) {
        const Eigen::Vector3d force = nodes.force(t);
        devices[t]->render({force, nodes.haptic().torque(t)}, 0);
        felt.most[t] = std::max(felt.most[t], force.norm());
        felt.change[t] = std::max(felt.change[t], (force - before[t]).norm());
        before[t] = force;
      }
      const DynamicOrgan& organ = nodes.world().organ(0);
      for (int n = 0; n < organ.mesh().nodes(); ++n)
        felt.fastest = std::max(felt.fastest, organ.model().velocity(n).norm());
    }
    felt.refused = nodes.refused();
    return felt;
  }

  const Scene scene_ = load_scene(PALPATE_SOURCE_DIR "/scenes/hepatectomy.toml");
  const std::vector<Archive> archives_ = load_or_precompute(scene_, ArchivePart::surface);
};

TEST_F(DrawnLobe, IsNotThrownAboutByTheToolThatItIsDrawnOver) {
  if (testing::kSanitized) GTEST_SKIP() << "minutes long";
  for (const double taken : {5.97, 6.57, 8.97}) {
    const Felt felt = draw(taken);
    std::printf("taken at %.2f s: forceps %.2f N, by %.3f N in a tick; scalpel %.2f N, by %.3f N; tissue %.1f m/s\n",
                taken, felt.most[0], felt.change[0], felt.most[1], felt.change[1], felt.fastest);
    for (const double most : felt.most) EXPECT_LT(most, 3);
    for (int t = 0; t < 2; ++t) EXPECT_LE(felt.change[t], scene_.tools[t].max_force_rate * kDt * (1 + 1e-9));
    EXPECT_LT(felt.fastest, 5);
    EXPECT_EQ(felt.refused, 0);
  }
}

}  // namespace
}  // namespace palpate
