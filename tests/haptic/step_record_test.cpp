#include "common/sim/step_record.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/haptic/block_scene.hpp"
#include "tests/tool/count_allocations.hpp"

namespace palpate {
namespace {

using testing::BlockScene;

// Six bodies in one place, each under the patches of eight tools: more nodal forces than one body alone can have.
TEST(StepRecordOf, ManyToolsOnManyBodiesTellsEveryContactAndNodalForceAndTakesNoMemoryForIt) {
  constexpr int kTools = 8, kBodies = 6;
  BlockScene block(kTools, 12);
  block.scene.contact.rule = ContactRule::patch;
  for (Tool& tool : block.scene.tools) std::get<ProbeSpec>(tool.end).radius = 0.015;
  for (int b = 1; b < kBodies; ++b) {
    QuasiStaticSpec body = std::get<QuasiStaticSpec>(block.scene.bodies[0]);
    body.name += std::to_string(b);
    block.scene.bodies.push_back(body);
    block.archives.push_back(block.archives[0]);
  }
  HapticStep step(block.scene, block.archives);
  StepRecord record{};
  prepare_record(step, record);
  std::array<DeviceSample, kTools> samples{};
  std::array<ToolDofs, kTools> dofs{};
  const auto press = [&](double depth) {
    for (int t = 0; t < kTools; ++t)
      samples[t].dofs = dofs[t] = tip_at(block.scene.tools[t], {0.01 * t - 0.035, 0, 0.015 - depth});
  };
  press(0);
  step.start(dofs);
  for (int i = 0; i <= 60; ++i) {
    press(1e-4 * i);
    step.step(dofs);
  }
  const auto before = allocations();
  fill_record(step, samples, 60, 0, record);
  EXPECT_EQ(allocations(), before);

  std::size_t contacts = 0, forces = 0;
  for (const HapticStep::Entry& entry : step.entries()) {
    entry.part->for_each_contact([&](const TouchContact&) { ++contacts; });
    entry.part->for_each_force([&](int, int, const Eigen::Vector3d&) { ++forces; });
  }
  ASSERT_GT(forces, 3u * TouchBody::kMaxContacts);
  EXPECT_EQ(record.contacts.size(), contacts);
  EXPECT_EQ(record.forces.size(), forces);
}

}  // namespace
}  // namespace palpate
