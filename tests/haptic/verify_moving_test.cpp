#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <fstream>
#include <functional>

#include "common/bus/log_reader.hpp"
#include "common/bus/log_writer.hpp"
#include "common/bus/memory_bus.hpp"
#include "common/bus/recorder.hpp"
#include "common/kernels/code_path.hpp"
#include "haptic_node/publisher.hpp"
#include "haptic_node/verify.hpp"
#include "tests/haptic/local_models_for_tests.hpp"

/// A log of haptic steps on moving tissue proves its forces by the local contact models in it.
namespace palpate {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr std::uint64_t kRunId = 5;
constexpr int kSteps = 2500;

Scene moving_scene(const fs::path& folder) {
  std::string tools;
  for (const int x : {0, 2})
    tools += fmt::format(
        "[[tool]]\nname = \"probe{0}\"\npivot = [0.0{0}, 0.0, 0.2]\nradius = 0.008\nmax_force_rate = 1e6\n"
        "device = \"bus\"\n",
        x);
  return parse_scene(R"([[body]]
name = "block"
mesh = "block.msh"
model = "tensor_mass"
young = 5000.0
poisson = 0.4
density = 1000.0
[[body.fixed]]
box = [[-1.0, -1.0, -0.0501], [1.0, 1.0, -0.0499]]
)" + tools,
                     folder / "scene.toml");
}

class VerifyMoving : public ::testing::Test {
 protected:
  VerifyMoving() {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "block.msh") << "never read";
    record();
  }
  ~VerifyMoving() override { fs::remove_all(folder_); }

  /// A haptic loop and a deform node that is started anew half way, without clocks: 2.5 s of two tools that press.
  void record() {
    const Scene scene = moving_scene(folder_);
    auto network = make_memory_network();
    auto bus = make_memory_bus(network), recorders = make_memory_bus(network);
    Recorder recorder(*recorders, {.file = log(), .version = "test"});
    const auto models = bus->writer(topics::local_contact_model);
    const auto text = bus->writer(topics::scene);
    text->write({.run = kRunId, .seq = 1, .scene_hash = "hash", .text = to_toml(scene), .code_path = code_path()});
    HapticStep haptic(scene, std::vector<Archive>(1));
    Publisher publisher(*bus, haptic, kRunId);
    const auto tip = [](int tool, int i) {
      return Vector3d(0.02 * tool, 0, 0.008 - 0.003 * std::sin(0.01 * i + tool));
    };
    const auto dofs_at = [&](int i) {
      return std::array{tip_at(scene.tools[0], tip(0, i)), tip_at(scene.tools[1], tip(1, i))};
    };
    haptic.start(dofs_at(0));
    auto record = std::make_unique<StepRecord>();
    std::uint64_t seq = 0;
    for (int i = 0; i < kSteps; ++i) {
      if (i % 1000 == 0) {
        HapticKeyframe keyframe{.step = static_cast<std::uint64_t>(i), .dt = haptic.dt(), .code_path = code_path()};
        keyframe.state.resize(haptic.state_size());
        haptic.save(keyframe.state);
        publisher.publish(keyframe);
      }
      const auto dofs = dofs_at(i);
      haptic.step(dofs);
      fill_record(haptic, std::array{DeviceSample{dofs[0], 0}, DeviceSample{dofs[1], 0}}, i, 1000 * i, *record);
      publisher.publish(*record);
      if (i == 1250) seq = 0;
      ++seq;
      for (int t = 0; t < 2; ++t) {
        LocalContactModel m = testing::empty_model(scene.tools[t], tip(t, i), static_cast<std::uint64_t>(i), seq);
        m.tool = static_cast<std::uint32_t>(t);
        m.run = i < 1250 ? 77 : 3;
        testing::add_square(m, 0, 300 + 0.01 * i);
        if (i % 2) testing::add_contact(m, tip(t, i) - Vector3d(0, 0, 0.008), {0, 0, -0.5 - 1e-4 * i}, 200);
        ASSERT_TRUE(models->write(m));
        const bool arrives = (i + t) % 3 == 0;  // not every one reaches the step
        ASSERT_TRUE(!arrives || haptic.consume(m));
      }
      recorder.step(std::chrono::nanoseconds(0));
    }
    ASSERT_EQ(recorder.finish().missing(), 0u);
  }

  /// Copies the log; `keep` may change an event, or drop it.
  void rewrite(const std::function<bool(LogEvent&)>& keep) {
    LogReader reader(log());
    LogWriter writer(changed(), std::size_t{1} << 30);
    writer.write(kHeaderChannel, reader.header().start_monotonic_ns, reader.header());
    for (LogEvent event; reader.next(event);)
      if (keep(event)) writer.write_payload(event.channel, event.receive_ns, event.payload);
    ASSERT_EQ(writer.finish().lost, 0u);
  }
  fs::path log() const { return folder_ / "session.lcmlog"; }
  fs::path changed() const { return folder_ / "changed.lcmlog"; }

  fs::path folder_ = fs::temp_directory_path() / fmt::format("palpate-verify-moving-{}", getpid());
};

TEST_F(VerifyMoving, EveryForceIsFoundAgainBitForBitOverARestartOfTheDeformNode) {
  const VerifyReport report = verify_log(log());
  EXPECT_TRUE(report.verified()) << report.mismatch << (report.gaps.empty() ? "" : report.gaps[0]);
  EXPECT_EQ(report.forces, 2u * kSteps);
}

TEST_F(VerifyMoving, OneBitOfOneModelIsFound) {
  std::uint64_t step = 0;
  rewrite([&](LogEvent& event) {
    LocalContactModel m;
    if (step != 0 || !event.read(topics::local_contact_model, m) || m.tool_step != 1203 || m.tool != 0) return true;
    double& force = m.contacts.at(0).force[2];
    force = std::bit_cast<double>(std::bit_cast<std::uint64_t>(force) ^ (1u << 20));
    event.payload.clear();
    encode(m, event.payload);
    step = m.tool_step + 1;
    return true;
  });
  ASSERT_EQ(step, 1204u);
  const VerifyReport report = verify_log(changed());
  EXPECT_NE(report.mismatch.find("step 1204, tool 0"), std::string::npos) << report.mismatch;
}

TEST_F(VerifyMoving, AModelThatTheLogLacksIsAGapUpToTheNextKeyframe) {
  rewrite([](LogEvent& event) {
    LocalContactModel m;
    return !(event.read(topics::local_contact_model, m) && m.tool_step == 1200 && m.tool == 0);
  });
  const VerifyReport report = verify_log(changed());
  EXPECT_TRUE(report.mismatch.empty()) << report.mismatch;
  ASSERT_EQ(report.gaps.size(), 1u);
  EXPECT_EQ(report.gaps[0],
            "cannot verify steps 1201 to 1999: the local contact model 1201 of tool 0 of step 1201 is not in the log");
  EXPECT_EQ(report.forces, 2u * (kSteps - 799));
}

TEST_F(VerifyMoving, ModelsThatNoStepUsedMayBeMissing) {
  rewrite([](LogEvent& event) {
    LocalContactModel m;
    return !(event.read(topics::local_contact_model, m) && (m.tool_step + m.tool) % 3 != 0);
  });
  EXPECT_TRUE(verify_log(changed()).verified());
}

}  // namespace
}  // namespace palpate
