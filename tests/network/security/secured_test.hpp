#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "tests/loopback/loopback_scene.hpp"
#include "tests/network/hosts_or_skip.hpp"
#include "tools/keys/key_folder.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate::testing {

inline keys::Period this_month() {
  constexpr std::time_t day = 24 * 60 * 60;
  return {std::time(nullptr) - day, std::time(nullptr) + 30 * day};
}

/// What a secured_peer did.
struct Outcome {
  std::uint64_t wrote = 0;
  int readers = 0;  ///< that matched at the same time, at most
  struct Heard {
    std::uint64_t samples = 0, last = 0;  ///< the last one's number
  };
  std::map<unsigned, Heard> heard;  ///< by tool
  std::string refusal;              ///< the sentence by which it was refused, if it was
  std::uint64_t of(unsigned tool) const { return heard.contains(tool) ? heard.at(tool).samples : 0; }
  std::uint64_t last_of(unsigned tool) const { return heard.contains(tool) ? heard.at(tool).last : 0; }
};

/// What one secured_peer is to do.
struct PeerTask {
  std::filesystem::path keys;  ///< "-": none
  std::string role, writes, reads;
  unsigned tool;
  std::string environment = "";
};

/// A secured_peer that runs.
class Peer {
 public:
  Peer(const PeerTask& task, int domain, const std::string& device, const std::string& other)
      : process_("secured_peer",
                 {"/bin/sh", "-c",
                  fmt::format("{} exec {} {} {} {} {} {} {} {} {}", task.environment, program("secured_peer"), domain,
                              device, other, task.keys.string(), task.role, task.writes, task.reads, task.tool)}) {}

  /// Whether it has heard a tool more than a hundred times.
  bool heard(unsigned tool) {
    take();
    return heard_.contains(tool);
  }
  /// Ends it if it does not by itself.
  Outcome outcome() {
    process_.interrupt();
    return outcome_of_itself();
  }
  /// Of one that is refused and ends.
  Outcome outcome_of_itself() {
    EXPECT_TRUE(process_.wait(std::chrono::seconds(30)));
    take();
    return outcome_;
  }

 private:
  void take() {
    for (const std::string& line : process_.take_lines()) take(line);
  }
  void take(const std::string& line) {
    unsigned tool = 0;
    unsigned long long samples = 0, last = 0, wrote = 0;
    int readers = 0;
    if (std::sscanf(line.c_str(), "heard %u", &tool) == 1)
      heard_.insert(tool);
    else if (std::sscanf(line.c_str(), "wrote %llu to %d readers", &wrote, &readers) == 2)
      outcome_.wrote = wrote, outcome_.readers = readers;
    else if (std::sscanf(line.c_str(), "tool %u: %llu samples, the last %llu", &tool, &samples, &last) == 3)
      outcome_.heard[tool] = {samples, last};
    else
      outcome_.refusal = line;
  }

  ChildProcess process_;
  Outcome outcome_;
  std::set<unsigned> heard_;  ///< tools
};

/// A copy of the middleware in a folder of its own, with the plugins that a test wants.
class OwnMiddleware {
 public:
  explicit OwnMiddleware(const std::filesystem::path& folder);
  /// The plugins, their access control being that of lenient_access.c.
  void add_lenient_plugins() const;
  /// What to set in the environment of a program that is to use it.
  std::string environment() const;

 private:
  std::filesystem::path library_, folder_;
};

}  // namespace palpate::testing
