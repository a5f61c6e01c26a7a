#include "tests/realtime/speed_watch.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstddef>

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;

/// [s] that a watch's cores have lost, when asked for the first and for the second time.
int tell_lost(int asked, int answer) {
  const SpeedWatch speed;
  std::byte any{};
  for (int i = 0; i < 2; ++i) {
    if (read(asked, &any, 1) != 1) return 1;
    const double lost = speed.lost();
    if (write(answer, &lost, sizeof lost) != sizeof lost) return 1;
  }
  return 0;
}

TEST(SpeedWatch, CountsWhatAMachineThatStandsStillDoesNotCompute) {
  std::array<int, 2> there{}, back{};
  ASSERT_EQ(pipe(there.data()) + pipe(back.data()), 0);
  const pid_t child = fork();
  if (child == 0) _exit(tell_lost(there[0], back[1]));
  const auto lost = [&] {
    const std::byte any{};
    double seen = -1;
    EXPECT_EQ(write(there[1], &any, 1), 1);
    EXPECT_EQ(read(back[0], &seen, sizeof seen), static_cast<ssize_t>(sizeof seen));
    return seen;
  };
  std::this_thread::sleep_for(50ms);
  const double before = lost();
  EXPECT_GE(before, 0);
  kill(child, SIGSTOP);
  std::this_thread::sleep_for(100ms);
  kill(child, SIGCONT);
  std::this_thread::sleep_for(20ms);
  EXPECT_GT(lost() - before, 0.09);
  int status = 1;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace palpate::testing
