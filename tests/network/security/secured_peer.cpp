// secured_peer DOMAIN INTERFACE PEER KEYS ROLE WRITES READS TOOL
// Joins with the keys of a role, or without where KEYS is -, writes each of the topics in WRITES (a list with commas,
// or -) as the tool TOOL at 200 Hz, and reads those in READS, until it is interrupted. It prints "heard T" once another
// tool is, a hundred times and more, and at the end "wrote N to M readers" and, for each other tool that was heard,
// "tool T: N samples, the last S" (its number), or the sentence by which it was refused. It does not count itself.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <sstream>
#include <vector>

#include "common/bus/dds_bus.hpp"
#include "common/realtime/periodic.hpp"
#include "common/realtime/shutdown.hpp"

namespace palpate {
namespace {

constexpr std::uint64_t kMany = 101;

void say(const std::string& words) {
  fmt::print("{}\n", words);
  std::fflush(stdout);
}

struct Peer {
  std::uint32_t tool = 0;
  std::uint64_t seq = 0, wrote = 0;
  int readers = 0;
  struct Heard {
    std::uint64_t samples = 0, last = 0;
  };
  std::map<std::uint32_t, Heard> heard;  ///< by tool
  std::vector<std::function<void()>> ports;

  template <class M>
  void writes(Bus& bus, const Topic<M>& topic, bool reads_it) {
    ports.push_back([this, reads_it, writer = std::shared_ptr<Writer<M>>(bus.writer(topic))] {
      M message;
      message.tool = tool;
      message.seq = seq;
      if constexpr (requires { message.depth; }) message.depth = 0.0123456789;  // so that a test can look for its bytes
      wrote += writer->write(message);
      readers = std::max(readers, writer->readers() - reads_it);
    });
  }
  template <class M>
  void reads(Bus& bus, const Topic<M>& topic) {
    ports.push_back([this, reader = std::shared_ptr<Reader<M>>(bus.reader(topic, Keep::all))] {
      while (const auto message = reader->take()) {
        if (message->tool == tool) continue;
        Heard& of = heard[message->tool];
        of.last = message->seq;
        if (++of.samples == kMany) say(fmt::format("heard {}", message->tool));
      }
    });
  }
};

/// Calls f with each of the topics that have a tool and stand in a list.
template <class F>
void for_each_named(const std::string& list, F&& f) {
  std::istringstream names(list == "-" ? "" : list);
  for (std::string name; std::getline(names, name, ',');)
    topics::for_each([&](const auto& topic) {
      if constexpr (requires(typename std::decay_t<decltype(topic)>::Message m) {
                      m.tool;
                      m.seq;
                    })
        if ("palpate/" + name == topic.name) f(topic);
    });
}

void run(char** a) {
  const std::string keys = a[4];
  const auto bus =
      make_dds_bus({.domain = std::stoi(a[1]),
                    .interface = std::string(a[2]) == "-" ? "" : a[2],
                    .peers = std::string(a[3]) == "-" ? std::vector<std::string>{} : std::vector<std::string>{a[3]},
                    .keys = keys == "-" ? "" : keys,
                    .role = a[5]});
  Peer peer;
  peer.tool = static_cast<std::uint32_t>(std::stoul(a[8]));
  for_each_named(a[6], [&](const auto& topic) {
    peer.writes(*bus, topic, std::string(a[7]).find(topic.name + 8) != std::string::npos);
  });
  for_each_named(a[7], [&](const auto& topic) { peer.reads(*bus, topic); });
  PeriodicTimer timer(200, 0);
  for (timer.wait(); !shutdown_requested(); timer.wait()) {
    ++peer.seq;
    for (const auto& port : peer.ports) port();
  }
  fmt::print("wrote {} to {} readers\n", peer.wrote, peer.readers);
  for (const auto& [tool, of] : peer.heard) fmt::print("tool {}: {} samples, the last {}\n", tool, of.samples, of.last);
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  if (argc != 9) return 2;
  palpate::catch_shutdown_signals();
  try {
    palpate::run(argv);
  } catch (const std::exception& error) {
    fmt::print("{}\n", error.what());
    return 1;
  }
  return 0;
}
