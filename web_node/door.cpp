#include "web_node/door.hpp"

#include <fmt/format.h>

#include <random>

namespace palpate::web {
namespace {

bool names_this_host(std::string_view host) {
  const auto colon = host.rfind(':');
  if (colon != host.npos && host.find(']', colon) == host.npos) host = host.substr(0, colon);
  return host == "127.0.0.1" || host == "localhost" || host == "[::1]";
}

/// Takes the same time wherever they differ.
bool same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned char>(a[i] ^ b[i]);
  return difference == 0;
}

}  // namespace

std::string_view Door::path(std::string_view target, std::string_view host) const {
  if (local_ && !names_this_host(host)) return {};
  target = target.substr(0, target.find('?'));
  if (!secret_.empty()) {
    if (target.size() <= secret_.size() + 1 || !target.starts_with('/')) return {};
    if (!same(target.substr(1, secret_.size()), secret_)) return {};
    target.remove_prefix(secret_.size() + 1);
  }
  return target.starts_with('/') ? target : std::string_view{};
}

bool Door::same_origin(std::string_view origin, std::string_view host) {
  const auto scheme = origin.find("://");
  return scheme != origin.npos && !host.empty() && origin.substr(scheme + 3) == host;
}

std::string random_secret() {
  std::random_device random;
  std::string secret;
  for (int word = 0; word < 4; ++word) secret += fmt::format("{:08x}", random());
  return secret;
}

}  // namespace palpate::web
