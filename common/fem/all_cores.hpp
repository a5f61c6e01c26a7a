#pragma once
#include <algorithm>
#include <atomic>
#include <future>
#include <thread>
#include <vector>

namespace palpate {

/// Threads for `count` pieces of work: one for each core, no more than pieces.
inline std::size_t core_count(std::size_t count) {
  return std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, std::max<std::size_t>(count, 1));
}

/// Calls what `make()` gives, once in each thread, with each number below `count`. Throws what a piece throws.
template <class Make>
void on_all_cores(std::size_t count, const Make& make) {
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    auto piece = make();
    for (std::size_t i = next++; i < count; i = next++) piece(i);
  };
  std::vector<std::future<void>> workers;
  for (std::size_t i = 0; i < core_count(count); ++i) workers.push_back(std::async(std::launch::async, work));
  for (auto& worker : workers) worker.get();
}

}  // namespace palpate
