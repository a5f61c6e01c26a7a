#include "tools/guard_summary.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace palpate {
namespace {

using nlohmann::json;

TEST(GuardSummary, WhatASoundRunDoesNotNeedIsAnInterventionAndItsLimitsAreNot) {
  EXPECT_EQ(interventions_in({{"haptic_node", nullptr}}), "");
  const json sound{
      {"haptic_node",
       {{"slew_limited_steps", 3}, {"passivity_limited_steps", 2}, {"late_tissue_steps", 6}, {"behind_s", 1}}},
      {"render_node", {{"behind_s", 4}}}};
  EXPECT_EQ(interventions_in(sound), "");
  EXPECT_EQ(limits_met_in(sound),
            "3 steps in which the force rose no faster than the port lets it, 2 steps damped, 6 steps in "
            "which tissue was felt whose time was late, 1 s in which the "
            "force's steps were late, 4 s in which pictures were left out");
  for (const char* key : {"fault_steps", "refused_samples", "followed_steps", "silent_device_steps", "refused_models",
                          "implausible_models", "implausible_force_steps", "stale_model_steps", "force_limited_steps",
                          "refused_contacts", "refused_messages"})
    EXPECT_TRUE(interventions_in({{"haptic_node", {{key, 7}}}}).starts_with("the hand was guarded: 7 ")) << key;
}

TEST(GuardSummary, StepsThatWereToldToNobodyAreNamed) {
  EXPECT_EQ(untold_steps_in({{"haptic_node", {{"dropped", 0}}}}), "");
  EXPECT_EQ(untold_steps_in({{"haptic_node", nullptr}}), "");
  EXPECT_TRUE(
      untold_steps_in({{"haptic_node", {{"dropped", 7}}}}).starts_with("the haptic node told nobody of 7 steps"));
}

TEST(GuardSummary, WhatAnyNodeRefusesIsAnIntervention) {
  for (const auto& [node, key] : {std::pair{"deform_node", "refused"},
                                  {"render_node", "refused"},
                                  {"web_node", "refused_messages"},
                                  {"web_node", "thrown_out"}})
    EXPECT_TRUE(interventions_in({{node, {{key, 7}}}}).starts_with("the hand was guarded: 7 ")) << node << " " << key;
}

}  // namespace
}  // namespace palpate
