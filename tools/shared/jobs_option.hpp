#pragma once
#include <algorithm>
#include <string>
#include <thread>

#include "common/cli/command_line.hpp"

namespace palpate {

/// --jobs of a command that runs its `parts` in processes of their own: how many at the same time, one a core where it
/// is not said.
inline void add_jobs_option(cli::Command& command, int& jobs, const std::string& parts) {
  jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  command.add_option("--jobs", jobs, parts + " at the same time (default: one a core)").between(1, 1024);
}

}  // namespace palpate
