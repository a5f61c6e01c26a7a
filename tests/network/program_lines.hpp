#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "tools/shared/child_process.hpp"

namespace palpate::testing {

/// The last line that a program printed, as JSON.
inline nlohmann::json last_line(ChildProcess& program) {
  const auto lines = program.take_lines();
  return lines.empty() ? nlohmann::json() : nlohmann::json::parse(lines.back());
}

/// Waits for a first line; false if the program ends without.
inline bool says_ready(ChildProcess& program) {
  for (int i = 0; i < 2000; ++i) {
    if (!program.take_lines().empty()) return true;
    if (!program.running()) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

/// Starts a command line, its standard output on a pipe.
inline ChildProcess start(const std::string& name, const std::string& command) {
  return {name, {"/bin/sh", "-c", "exec " + command}};
}

}  // namespace palpate::testing
