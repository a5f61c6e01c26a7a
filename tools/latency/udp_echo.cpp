#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "tools/latency/echo.hpp"

namespace palpate::latency {
namespace {

constexpr std::size_t kLength = 136;  // of a ToolState on the wire

class UdpEcho : public Echo {
 public:
  UdpEcho(const std::string& host, int port, Side side)
      : side_(side), socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    if (socket_ < 0) throw std::runtime_error(fmt::format("UDP: {}", std::strerror(errno)));
    try {
      side == Side::asks ? ask(host, port) : listen(port);
    } catch (...) {
      close(socket_);
      throw;
    }
  }
  ~UdpEcho() override { close(socket_); }

  void send(std::uint64_t seq) override {
    std::array<std::byte, kLength> bytes{};
    std::memcpy(bytes.data(), &seq, sizeof seq);
    if (partner_.sin_family == AF_INET)
      (void)sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&partner_),
                   sizeof partner_);
  }

  std::uint64_t receive(std::chrono::nanoseconds timeout) override {
    pollfd waits{socket_, POLLIN, 0};
    const timespec time{timeout.count() / 1'000'000'000, timeout.count() % 1'000'000'000};
    if (ppoll(&waits, 1, &time, nullptr) <= 0) return 0;
    std::array<std::byte, 2 * kLength> bytes;
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t got =
        recvfrom(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT, reinterpret_cast<sockaddr*>(&from), &size);
    if (got != static_cast<ssize_t>(kLength)) return 0;  // a stranger's
    if (side_ == Side::answers) partner_ = from;
    std::uint64_t seq = 0;
    std::memcpy(&seq, bytes.data(), sizeof seq);
    return seq;
  }

 private:
  void ask(const std::string& host, int port) {
    addrinfo hints{}, *found = nullptr;
    hints.ai_family = AF_INET;
    hints.ai_socktype = SOCK_DGRAM;
    const int error = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
    if (error != 0) throw std::runtime_error(fmt::format("UDP: no host {}: {}", host, gai_strerror(error)));
    std::memcpy(&partner_, found->ai_addr, sizeof partner_);
    freeaddrinfo(found);
  }
  void listen(int port) {
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_port = htons(static_cast<std::uint16_t>(port));
    if (bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0)
      throw std::runtime_error(fmt::format("UDP port {}: {}", port, std::strerror(errno)));
  }

  Side side_;
  int socket_;
  sockaddr_in partner_{};  ///< of the answering side: who asked last
};

}  // namespace

std::unique_ptr<Echo> udp_echo(const std::string& host, int port, Side side) {
  return std::make_unique<UdpEcho>(host, port, side);
}

}  // namespace palpate::latency
