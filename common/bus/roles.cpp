#include "common/bus/roles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "idl/topics.hpp"

namespace palpate {
namespace {

const std::vector<std::string> nodes{"haptic", "deform", "render", "driver", "recorder"};

bool holds(const std::vector<std::string>& list, const std::string& word) {
  return std::ranges::find(list, word) != list.end();
}

/// Nodes that a cell of the table names: "-", "all", "all but haptic", "who asked" (of the clock) or "deform, render".
std::vector<std::string> named_in(const std::string& cell) {
  if (cell == "-") return {};
  if (cell == "all") return nodes;
  if (cell == "who asked") return named_in(topics::clock_probe.writer);
  std::vector<std::string> named;
  if (cell.starts_with("all but ")) {
    std::ranges::copy_if(nodes, std::back_inserter(named),
                         [&](const std::string& node) { return "all but " + node != cell; });
    if (named.size() + 1 == nodes.size()) return named;
  } else {
    std::istringstream words(cell);
    for (std::string word; std::getline(words >> std::ws, word, ',');) named.push_back(word);
    if (!named.empty() && std::ranges::all_of(named, [](const std::string& word) { return holds(nodes, word); }))
      return named;
  }
  throw std::logic_error(fmt::format("the table of topics names '{}', which is no role", cell));
}

}  // namespace

const std::vector<std::string>& bus_roles() {
  static const std::vector<std::string> roles = [] {
    std::vector<std::string> all = nodes;
    all.insert(all.end(), {"observer", "player", "latency"});
    return all;
  }();
  return roles;
}

Rights rights_of(const std::string& role) {
  if (!holds(bus_roles(), role))
    throw std::runtime_error(fmt::format("'{}' is no role on the bus: {}", role, fmt::join(bus_roles(), ", ")));
  const bool reads_all = role == "recorder" || role == "observer" || role == "latency";
  Rights rights;
  topics::for_each([&](const auto& topic) {
    const bool writes = role == "player" || holds(named_in(topic.writer), role);
    const bool reads = reads_all || holds(named_in(topic.readers), role);
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
