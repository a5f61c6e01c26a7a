#include "common/bus/domain_claim.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <charconv>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace palpate {
namespace {

/// A socket whose abstract name, which the kernel gives to one and takes back at its death, stands for the domain as
/// `who` has it, "run" or "haptic"; -1 if another has it.
int try_claim(const char* who, int domain) {
  const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = fmt::format("palpate-{}-domain-{}", who, domain);
  std::memcpy(address.sun_path + 1, name.data(), name.size());
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  if (socket >= 0 && bind(socket, reinterpret_cast<const sockaddr*>(&address), length) == 0) return socket;
  if (socket >= 0) close(socket);
  return -1;
}

}  // namespace

DomainClaim::DomainClaim(int domain) : domain_(domain), socket_(try_claim("run", domain)) {
  if (socket_ < 0)
    throw std::runtime_error(
        fmt::format("domain {} is another run's on this host; --domain auto takes one that is free", domain));
}

DomainClaim DomainClaim::first_free(int from) {
  for (int domain = from; domain <= kMaxDomain; ++domain) {
    DomainClaim run(domain, try_claim("run", domain));
    if (run.socket_ >= 0 && of_haptic_node(domain).socket_ >= 0) return run;
  }
  throw std::runtime_error(fmt::format("other runs have all domains from {} to {} on this host", from, kMaxDomain));
}

DomainClaim DomainClaim::of_haptic_node(int domain) {
  return {domain, try_claim("haptic", domain)};
}

DomainClaim::~DomainClaim() {
  if (socket_ >= 0) close(socket_);
}

DomainClaim::DomainClaim(DomainClaim&& other) noexcept
    : domain_(other.domain_), socket_(std::exchange(other.socket_, -1)) {}

int parse_domain(const std::string& text) {
  int domain = -1;
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, domain);
  if (error != std::errc{} || at != end || domain < 0 || domain > DomainClaim::kMaxDomain)
    throw std::runtime_error(
        fmt::format("--domain {}: give a number from 0 to {}, or auto", text, DomainClaim::kMaxDomain));
  return domain;
}

}  // namespace palpate
