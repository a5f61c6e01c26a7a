#pragma once
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>

namespace palpate::testing {

/// A DDS domain of this process's own while it lives, so that tests may run side by side: the first from 1 to 100 whose
/// file in TMPDIR no other process has locked. Programs that it starts do not inherit the lock.
inline int own_domain() {
  static const int domain = [] {
    for (int candidate = 1; candidate <= 100; ++candidate) {
      const auto file = std::filesystem::temp_directory_path() / fmt::format("palpate-domain-{}", candidate);
      const int descriptor = open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
      if (descriptor >= 0 && flock(descriptor, LOCK_EX | LOCK_NB) == 0) return candidate;
      close(descriptor);
    }
    throw std::runtime_error("no DDS domain is free for this test");
  }();
  return domain;
}

/// A UDP port that no DDS participant on this host takes: the last one of the domain's 250.
inline int own_udp_port() {
  return 7400 + 250 * own_domain() + 249;
}

}  // namespace palpate::testing
