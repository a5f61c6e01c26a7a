#pragma once
#include <chrono>
#include <thread>

namespace palpate::testing {

/// Whether `done` becomes true before the time is up; it is asked twenty times a second.
template <class Done>
bool comes_within(std::chrono::seconds limit, Done&& done) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return true;
}

}  // namespace palpate::testing
