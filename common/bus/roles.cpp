#include "common/bus/roles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "idl/topics.hpp"

namespace palpate {

std::uint32_t role_bit(const std::string& role) {
  const auto* at = std::ranges::find(roles::names, role);
  return at == std::end(roles::names) ? 0 : 1u << (at - std::begin(roles::names));
}

const std::vector<std::string>& bus_roles() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> roles(std::begin(roles::names), std::end(roles::names));
    roles.insert(roles.end(), {"observer", "player", "latency"});
    return roles;
  }();
  return all;
}

Rights rights_of(const std::string& role) {
  if (std::ranges::find(bus_roles(), role) == bus_roles().end())
    throw std::runtime_error(fmt::format("'{}' is no role on the bus: {}", role, fmt::join(bus_roles(), ", ")));
  const std::uint32_t bit = role_bit(role);
  const bool reads_all = role == "recorder" || role == "observer" || role == "latency";
  Rights rights;
  topics::for_each([&](const auto& topic) {
    const bool writes = role == "player" || (topic.writers & bit) != 0;
    const bool reads = reads_all || (topic.readers & bit) != 0;
    if (writes) rights.writes.push_back(topic.name);
    if (reads) rights.reads.push_back(topic.name);
    if (topic.qos.recorder_depth == 0) return;
    if (writes) rights.writes.push_back(recorders_name(topic));
    if (reads_all) rights.reads.push_back(recorders_name(topic));
  });
  if (role == "latency") {
    rights.writes.push_back("palpate/latency_*");
    rights.reads.push_back("palpate/latency_*");
  }
  return rights;
}

}  // namespace palpate
