#pragma once
#include <functional>
#include <span>

#include "tools/stability/case.hpp"

namespace palpate::stability {

/// A point that has been run, how long it took, and what came of it.
struct GuardedRow {
  std::size_t point;
  double seconds;
  Row row;
};

/// Runs each point in a process of its own, `jobs` at a time, so that a crash or hang becomes the outcome `failed`.
/// `said` hears of each as it ends. The calling process must have no threads at work. Throws std::runtime_error if no
/// process can be started.
void run_guarded(std::span<const Point> points, int jobs, const std::function<void(const GuardedRow&)>& said);

/// One of them.
Row run_guarded(const Point& point);

}  // namespace palpate::stability
