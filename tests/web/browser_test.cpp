#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/bus/domain.hpp"
#include "tests/realtime/host_watch.hpp"
#include "tests/sanitized.hpp"

namespace palpate {
namespace {

// Debian's, which has Debian's selenium.
constexpr int kNoBrowser = 77;

/// Runs one case of browser.py, which says what it saw.
void run(const std::string& name) {
  const std::string command = fmt::format(
      "/usr/bin/python3 {0}/tests/web/browser.py {1} --bin {2} --source {0} --domain {3} --cache {4}/web_cache",
      PALPATE_SOURCE, name, PALPATE_BIN, testing::own_domain(), PALPATE_BUILD);
  const int status = std::system(command.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == kNoBrowser)
    GTEST_SKIP() << "no chromium with its driver and python3-selenium here; scripts/install.sh tests installs them";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(WebBrowser, AHandPressesTheOrganAndLetsGo) {
  run("press");
}

TEST(WebBrowser, AToolInTissueGoesOutOfItBeforeItGoesElsewhere) {
  run("way");
}

TEST(WebBrowser, APedalComesUpWhereverTheFocusIs) {
  run("pedal");
}

TEST(WebBrowser, JawsAreThoseOfTheChosenToolAndAnIdlePadLeavesThemAlone) {
  run("jaws");
}

TEST(WebBrowser, AFingerOnAPhoneAndACapOfSixAxesMoveTheTool) {
  run("touch");
}

TEST(WebBrowserShared, TwoPagesShareAToolAndAServerThatReturnsIsFoundAgain) {
  run("share");
}

TEST(WebBrowser, ASlowPageDoesNotLoseTheHand) {
  run("slow");
}

TEST(WebBrowser, APageWhoseNetworkIsCutLetsGo) {
  run("cut_off");
}

TEST(WebBrowser, OfANodeThatStandsThePageSaysNoRateAndNoForce) {
  run("silent");
}

TEST(WebBrowser, ACutAppears) {
  run("cut");
}

TEST(WebBrowser, TheCameraGoesWhereTheMouseLeadsItAndTheEndoscopeIsTheScenesOwn) {
  run("camera");
}

TEST(WebBrowser, ACatheterIsSeenInsideADuctThatIsSeenThrough) {
  run("through");
}

TEST(WebHostile, PagesThatMisbehaveAreThrownOutAndTheForceKeepsItsRate) {
  const auto file = std::filesystem::temp_directory_path() / fmt::format("palpate-ticks-{}", getpid());
  const testing::HostWatch host;
  run("hostile --ticks " + file.string());
  if (IsSkipped()) return;
  double ticks = 0, seconds = 0;
  std::int64_t end = 0;
  std::ifstream(file) >> ticks >> seconds >> end;
  std::filesystem::remove(file);
  ASSERT_GT(seconds, 0);
  ASSERT_GT(end, 0);
  // The loop ends within half a second before its node does.
  const auto begin = end - static_cast<std::int64_t>(1e9 * (seconds + 0.5));
  EXPECT_GT(ticks / (seconds - host.stood_still(begin, end)), testing::kSanitized ? 500 : 990);
}

}  // namespace
}  // namespace palpate
