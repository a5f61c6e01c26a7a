// unless_held_up PROGRAM [ARGUMENT ...]: runs a suite whose verdict hangs on time. On a virtual machine the host takes
// the processor away now and then; some say so to the kernel ("steal"), of others a watch on each core knows. A suite
// that fails (status 1) while the host took 50 ms says nothing: it runs again, three times at most, the last verdict
// counts, and each run that did not is noted in $XDG_CACHE_HOME/held_up, which scripts/test.sh prints. Where nothing is
// taken, nothing runs twice; nor does a long form, which looks for what is rare, nor what ends otherwise than with
// status 1, as what crashes.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>

#include "common/realtime/clock.hpp"
#include "tests/realtime/host_watch.hpp"

namespace {

constexpr int kRuns = 3;
constexpr double kTaken = 0.05;  // [s]
constexpr int kCannotRun = 127;

[[noreturn]] void become(char** arguments) {
  execvp(arguments[0], arguments);
  fmt::print(stderr, "unless_held_up: cannot run {}\n", arguments[0]);
  _exit(kCannotRun);
}

/// Exit status of the suite; 128 + signal where one ended it.
int run(char** arguments) {
  const pid_t pid = fork();
  if (pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    become(arguments);
  }
  int status = 0;
  if (pid < 0 || waitpid(pid, &status, 0) != pid) return kCannotRun;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void note(const std::string& line) {
  fmt::print("{}\n", line);
  const char* const cache = std::getenv("XDG_CACHE_HOME");
  std::ofstream(std::filesystem::path(cache ? cache : "/tmp") / "held_up", std::ios::app) << line << '\n';
}

}  // namespace

int main(int count, char** arguments) {
  using palpate::testing::HostWatch;
  if (count < 2) {
    fmt::print(stderr, "use: unless_held_up PROGRAM [ARGUMENT ...]\n");
    return 2;
  }
  if (std::getenv("PALPATE_LONG_TESTS")) become(arguments + 1);
  for (int left = kRuns - 1;; --left) {
    const HostWatch host(HostWatch::By::host);
    const double stolen = HostWatch::stolen();
    const std::int64_t begin = palpate::now_ns();
    const int status = run(arguments + 1);
    const double taken = std::max(HostWatch::stolen() - stolen, host.stood_still(begin, palpate::now_ns()));
    if (status != 1 || left == 0 || taken < kTaken) return status;
    note(fmt::format("{} {}: failed while the host took {:.0f} ms; runs again",
                     std::filesystem::path(arguments[1]).filename().string(),
                     fmt::join(std::span(arguments + 2, arguments + count), " "), 1e3 * taken));
  }
}
