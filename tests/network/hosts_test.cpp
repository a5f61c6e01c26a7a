#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <thread>

#include "tests/network/hosts_or_skip.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

/// The kernel's number of a namespace.
ino_t number_of(const NetworkNamespace& space) {
  struct stat status {};
  fstat(space.descriptor(), &status);
  return status.st_ino;
}

/// Whether any program is in the namespace.
bool inhabited(ino_t number) {
  const std::string name = fmt::format("net:[{}]", number);
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator("/proc"))
    if (fs::read_symlink(entry.path() / "ns/net", gone) == name) return true;
  return false;
}

/// A program in the namespace, as a node would be, that ends with its parent.
void start_sleeper(const NetworkNamespace& space) {
  const Inside here(space);
  static std::vector<ChildProcess> sleepers;
  sleepers.emplace_back("sleep", std::vector<std::string>{"/bin/sleep", "60"});
}

class HostsTest : public ::testing::TestWithParam<TwoHosts::Link> {};

TEST_P(HostsTest, ACrashLeavesNothingBehind) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t crashing = fork();
  if (crashing == 0) {
    std::array<ino_t, 2> numbers{};
    try {
      const TwoHosts hosts(GetParam());
      start_sleeper(hosts.a());
      numbers = {number_of(hosts.a()), number_of(hosts.b())};
      (void)!write(ends[1], numbers.data(), sizeof numbers);
      sleep(60);
    } catch (const std::runtime_error&) {
      (void)!write(ends[1], numbers.data(), sizeof numbers);
    }
    _exit(0);
  }
  std::array<ino_t, 2> numbers{};
  ASSERT_EQ(read(ends[0], numbers.data(), sizeof numbers), static_cast<ssize_t>(sizeof numbers));
  const bool made = numbers[0] != 0;
  EXPECT_EQ(inhabited(numbers[0]), made);
  kill(crashing, SIGKILL);
  waitpid(crashing, nullptr, 0);
  if (!made) GTEST_SKIP() << "network namespaces or devices are not permitted here";

  const auto limit = std::chrono::steady_clock::now() + 5s;
  const auto left = [&] { return inhabited(numbers[0]) || inhabited(numbers[1]); };
  while (left() && std::chrono::steady_clock::now() < limit) std::this_thread::sleep_for(10ms);
  EXPECT_FALSE(left());
}

INSTANTIATE_TEST_SUITE_P(Joined, HostsTest, ::testing::Values(TwoHosts::Link::veth, TwoHosts::Link::relay),
                         [](const auto& link) { return link.param == TwoHosts::Link::veth ? "ByVeth" : "ByRelay"; });

}  // namespace
}  // namespace palpate::testing
