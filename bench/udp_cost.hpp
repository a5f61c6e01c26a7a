#pragma once
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "common/realtime/clock.hpp"
#include "tests/network/two_hosts.hpp"

namespace palpate::bench {

/// Processor time [s] that the sender of one message of 200 bytes needs for `receivers` sockets on another host, each
/// with a thread that waits for it: one datagram to a multicast group, or one to each.
inline double bare_udp_cost(const testing::NetworkNamespace& from, const testing::NetworkNamespace& to, int receivers,
                            bool multicast) {
  constexpr int messages = 1000, first_port = 5000;
  constexpr const char* group = "239.255.77.1";
  const auto address_of = [&](int i) {
    sockaddr_in a{};
    a.sin_family = AF_INET;
    a.sin_port = htons(static_cast<std::uint16_t>(first_port + (multicast ? 0 : i)));
    inet_pton(AF_INET, multicast ? group : testing::TwoHosts::address_b, &a.sin_addr);
    return a;
  };
  std::atomic<bool> over{false};
  std::vector<std::jthread> threads;
  std::vector<int> sockets;
  {
    const testing::Inside there(to);
    for (int i = 0; i < receivers; ++i) {
      const int s = sockets.emplace_back(socket(AF_INET, SOCK_DGRAM, 0)), on = 1;
      setsockopt(s, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
      const sockaddr_in own = address_of(i);
      ip_mreq membership{};
      inet_pton(AF_INET, group, &membership.imr_multiaddr);
      inet_pton(AF_INET, testing::TwoHosts::address_b, &membership.imr_interface);
      const bool joined =
          !multicast || setsockopt(s, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0;
      if (!joined || bind(s, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0)
        throw std::runtime_error("a socket for bare UDP cannot be had");
      threads.emplace_back([s, &over] {
        std::array<char, 256> message;
        for (pollfd ready{s, POLLIN, 0}; !over; ready.revents = 0)
          if (poll(&ready, 1, 50) > 0) (void)recv(s, message.data(), message.size(), 0);
      });
    }
  }
  const testing::Inside here(from);
  const int out = socket(AF_INET, SOCK_DGRAM, 0);
  const std::array<char, 200> message{};
  timespec before{}, after{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &before);
  std::int64_t next = now_ns();
  for (int i = 0; i < messages; ++i) {
    for (int r = 0; r < (multicast ? 1 : receivers); ++r) {
      const sockaddr_in at = address_of(r);
      (void)sendto(out, message.data(), message.size(), 0, reinterpret_cast<const sockaddr*>(&at), sizeof at);
    }
    sleep_until_ns(next += 1'000'000);
  }
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &after);
  over = true;
  threads.clear();
  for (const int s : sockets) close(s);
  close(out);
  return (static_cast<double>(after.tv_sec - before.tv_sec) +
          1e-9 * static_cast<double>(after.tv_nsec - before.tv_nsec)) /
         messages;
}

}  // namespace palpate::bench
