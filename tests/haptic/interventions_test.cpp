#include "haptic_node/interventions.hpp"

#include <gtest/gtest.h>

#include "idl/messages.hpp"

namespace palpate {
namespace {

TEST(Interventions, AreToldOnceAndStandInTheStatusWhileTheyLast) {
  Interventions told;
  told.look({});
  EXPECT_TRUE(told.news().empty());
  EXPECT_EQ(told.status(), "");
  told.look({.flags = stale_model, .refused_samples = 3});
  EXPECT_EQ(told.news().size(), 2u);
  EXPECT_NE(told.status().find("samples of a device are refused"), std::string::npos);
  told.look({.flags = stale_model, .refused_samples = 3});
  EXPECT_TRUE(told.news().empty());
  EXPECT_NE(told.status().find("the force of moving tissue fades"), std::string::npos);
  told.look({.flags = fault | stale_model, .refused_samples = 4});
  EXPECT_EQ(told.news().size(), 1u);
  EXPECT_NE(told.status().find("a fault has taken the force away"), std::string::npos);
  told.look({.refused_samples = 4});
  EXPECT_EQ(told.status(), "");
}

}  // namespace
}  // namespace palpate
