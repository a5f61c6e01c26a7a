#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "tests/bus/domain.hpp"

namespace palpate {
namespace {

// Debian's, which has Debian's selenium.
constexpr int kNoBrowser = 77;

/// Runs one case of browser.py, which says what it saw.
void run(const char* name) {
  const std::string command = fmt::format(
      "/usr/bin/python3 {0}/tests/web/browser.py {1} --bin {2} --source {0} --domain {3} --cache {4}/web_cache",
      PALPATE_SOURCE, name, PALPATE_BIN, testing::own_domain(), PALPATE_BUILD);
  const int status = std::system(command.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == kNoBrowser)
    GTEST_SKIP() << "no chromium with its driver and python3-selenium here; scripts/install.sh installs them";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(WebBrowser, AHandPressesTheOrganAndLetsGo) {
  run("press");
}

TEST(WebBrowserShared, TwoPagesShareAToolAndAServerThatReturnsIsFoundAgain) {
  run("share");
}

TEST(WebBrowser, ACutAppears) {
  run("cut");
}

TEST(WebHostile, PagesThatMisbehaveAreThrownOutAndTheForceKeepsItsRate) {
  run("hostile");
}

}  // namespace
}  // namespace palpate
