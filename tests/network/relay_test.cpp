// The relay between two TUN devices, measured with plain UDP.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "common/realtime/clock.hpp"
#include "tests/network/hosts_or_skip.hpp"

namespace palpate::testing {
namespace {

constexpr int kPort = 5077, kSize = 1000;
constexpr std::int64_t kQuietNs = 300'000'000;

class Socket {
 public:
  Socket(const NetworkNamespace& space, const char* address) {
    const Inside here(space);
    descriptor_ = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    const sockaddr_in own = of(address);
    if (bind(descriptor_, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0)
      throw std::runtime_error(std::strerror(errno));
  }
  ~Socket() { close(descriptor_); }
  Socket(const Socket&) = delete;

  void send(const char* to, std::int64_t number, int bytes = kSize) {
    std::vector<std::int64_t> packet(bytes / 8);
    packet[0] = number;
    packet[1] = now_ns();
    const sockaddr_in peer = of(to);
    sendto(descriptor_, packet.data(), bytes, 0, reinterpret_cast<const sockaddr*>(&peer), sizeof peer);
  }
  struct Arrival {
    std::int64_t number, sent, came;
  };
  /// False if nothing has come.
  bool take(std::vector<Arrival>& arrivals) {
    const std::size_t before = arrivals.size();
    std::int64_t packet[kSize / 8];
    while (recv(descriptor_, packet, sizeof packet, 0) > 0) arrivals.push_back({packet[0], packet[1], now_ns()});
    return arrivals.size() > before;
  }

 private:
  static sockaddr_in of(const char* address) {
    sockaddr_in a{.sin_family = AF_INET, .sin_port = htons(kPort)};
    inet_pton(AF_INET, address, &a.sin_addr);
    return a;
  }
  int descriptor_;
};

class RelayTest : public ::testing::Test {
 protected:
  void SetUp() override{PALPATE_TWO_HOSTS_OR_SKIP(hosts_, TwoHosts::Link::relay)}

  /// Sends packets from A to B, one a millisecond, under what the line asks for, and takes what comes until for a while
  /// nothing has.
  std::vector<Socket::Arrival> cross(const std::string& line, int packets) {
    hosts_->impair(line);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    Socket from(hosts_->a(), TwoHosts::address_a), to(hosts_->b(), TwoHosts::address_b);
    std::vector<Socket::Arrival> arrivals;
    const std::int64_t begin = now_ns();
    for (int i = 0; i < packets; ++i) {
      sleep_until_ns(begin + i * std::int64_t{1'000'000});
      from.send(TwoHosts::address_b, i);
      to.take(arrivals);
    }
    std::int64_t last = now_ns();
    do {
      sleep_until_ns(now_ns() + 500'000);
      if (to.take(arrivals)) last = now_ns();
    } while (now_ns() < last + kQuietNs);
    hosts_->impair("both clear");
    return arrivals;
  }

  std::unique_ptr<TwoHosts> hosts_;
};

/// Share of the packets' times [ms] from A to B.
double delay_ms(const std::vector<Socket::Arrival>& arrivals, double share) {
  std::vector<std::int64_t> times;
  for (const auto& a : arrivals) times.push_back(a.came - a.sent);
  if (times.empty()) return -1;
  std::ranges::sort(times);
  return 1e-6 * static_cast<double>(times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))]);
}

TEST_F(RelayTest, DelayAndJitterAreThoseAskedFor) {
  // The reading of the arrivals, once a millisecond and later under load, is in the measured times.
  const auto good = cross("both clear", 200);
  EXPECT_EQ(good.size(), 200u);
  const double floor = delay_ms(good, 0.5);
  EXPECT_LT(floor, 5);
  const auto late = cross("ab delay 0.05", 200);
  EXPECT_EQ(late.size(), 200u);
  EXPECT_GE(delay_ms(late, 0), 50);
  EXPECT_LT(delay_ms(late, 0.5), 50 + floor + 3);
  const auto spread = cross("ab delay 0.02 jitter 0.04", 400);
  EXPECT_EQ(spread.size(), 400u);
  EXPECT_GE(delay_ms(spread, 0), 20);
  EXPECT_GT(delay_ms(spread, 0.5), 40) << "in order, each waits for the latest before it";
  EXPECT_LT(delay_ms(spread, 0.5), 60 + floor + 3);
  RecordProperty("floor_ms", fmt::format("{:.3f}", floor));
  RecordProperty("delay_50_ms", fmt::format("{:.3f}", delay_ms(late, 0.5)));
}

TEST_F(RelayTest, LossDuplicatesAndOrderAreThoseAskedFor) {
  const auto lossy = cross("ab loss 0.3", 700);
  EXPECT_NEAR(static_cast<double>(lossy.size()), 490, 61) << "five standard deviations";
  const auto doubled = cross("ab duplicate 0.2", 400);
  EXPECT_NEAR(static_cast<double>(doubled.size()), 480, 40);
  const auto mixed = cross("ab reorder 0.2", 200);
  EXPECT_EQ(mixed.size(), 200u);
  EXPECT_FALSE(std::ranges::is_sorted(mixed, {}, &Socket::Arrival::number));
  RecordProperty("lost_of_700", std::to_string(700 - static_cast<int>(lossy.size())));
}

TEST_F(RelayTest, RateAndCutAreThoseAskedFor) {
  // 1,028 bytes with the headers each ms over 4.112 Mbit/s: a packet takes 2 ms, so that half of them cross.
  const auto slow = cross("ab rate 4112000 queue 20000", 500);
  ASSERT_GT(slow.size(), 200u);
  EXPECT_LT(slow.size(), 300u);
  const double seconds = 1e-9 * static_cast<double>(slow.back().came - slow.front().sent);
  EXPECT_LE(8 * 1028 * static_cast<double>(slow.size()) / seconds, 1.05 * 4112000);
  EXPECT_TRUE(cross("both cut 1", 50).empty());
  EXPECT_EQ(cross("both clear", 50).size(), 50u);
}

}  // namespace
}  // namespace palpate::testing
