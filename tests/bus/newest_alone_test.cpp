#include <gtest/gtest.h>
#include <sys/socket.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>

#include "common/bus/dds_bus.hpp"
#include "tests/bus/domain.hpp"

namespace palpate {
namespace {

std::set<int> sockets() {
  std::set<int> found;
  for (const auto& fd : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code gone;
    if (std::filesystem::read_symlink(fd, gone).string().starts_with("socket:"))
      found.insert(std::stoi(fd.path().filename()));
  }
  return found;
}

/// [bytes] of the largest receive buffer of a bus; the kernel counts twice what is asked for.
int largest_buffer(bool newest_alone) {
  const std::set<int> others = sockets();
  const auto bus = make_dds_bus({.domain = testing::own_domain(), .newest_alone = newest_alone});
  int largest = 0;
  for (const int socket : sockets()) {
    int bytes = 0;
    socklen_t size = sizeof bytes;
    if (!others.contains(socket) && getsockopt(socket, SOL_SOCKET, SO_RCVBUF, &bytes, &size) == 0)
      largest = std::max(largest, bytes);
  }
  return largest;
}

// At 10,000 datagrams a second, half a kilobyte each, 8 MB are what came in a second and more.
TEST(NewestAlone, ItsSocketHoldsAFractionOfASecond) {
  const int newest = largest_buffer(true), all = largest_buffer(false);
  EXPECT_GT(newest, 0);
  EXPECT_LE(newest, 2 * (2 << 20));
  EXPECT_GE(all, newest) << "as large where the kernel lets no socket have more";
}

}  // namespace
}  // namespace palpate
