#pragma once
#include <fmt/format.h>
#include <unistd.h>

#include <fstream>

namespace palpate::testing {

/// [MB] Resident memory of a process.
inline double resident_mb(pid_t pid) {
  std::ifstream in(fmt::format("/proc/{}/statm", pid));
  double total = 0, resident = 0;
  in >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

}  // namespace palpate::testing
