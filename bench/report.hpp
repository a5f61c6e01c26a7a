#pragma once
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <string_view>
#include <vector>

/// What every benchmark shares: samples of times, and rows of the form bench,case,metric,value,unit on
/// stdout. scripts/bench.sh adds machine and commit.
namespace palpate::bench {

inline void report(std::string_view bench, std::string_view name, std::string_view metric, double value,
                   std::string_view unit) {
  fmt::print("{},{},{},{:.6g},{}\n", bench, name, metric, value, unit);
  std::fflush(stdout);
}

/// True if the program was called with --quick: fewer samples, same questions.
inline bool quick(int argc, char** argv) {
  return std::any_of(argv + 1, argv + argc, [](const char* a) { return std::string_view(a) == "--quick"; });
}

/// Keeps the compiler from dropping the work that made the value.
template <class T>
inline void keep(const T& value) {
  asm volatile("" : : "g"(&value) : "memory");
}

/// Times [s] of one piece of work, in order of measurement.
class Samples {
 public:
  void add(double seconds) { values_.push_back(seconds); }

  /// Runs work(i) `warm_up` times unmeasured with i < 0, then `count` times with i = 0, 1, ...
  template <class Work>
  void measure(int warm_up, int count, Work&& work) {
    values_.reserve(values_.size() + count);
    for (int i = -warm_up; i < 0; ++i) work(i);
    for (int i = 0; i < count; ++i) {
      const auto begin = Clock::now();
      work(i);
      add(std::chrono::duration<double>(Clock::now() - begin).count());
    }
  }

  /// The smallest sample that a part q of all does not exceed; 0 without samples.
  double quantile(double q) const {
    if (values_.empty()) return 0;
    std::vector<double> sorted = values_;
    const auto at = std::min(sorted.size() - 1, static_cast<std::size_t>(q * sorted.size()));
    std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
    return sorted[at];
  }
  double median() const { return quantile(0.5); }
  double p99() const { return quantile(0.99); }
  double p999() const { return quantile(0.999); }
  double max() const { return quantile(1); }
  std::size_t size() const { return values_.size(); }

 private:
  using Clock = std::chrono::steady_clock;
  std::vector<double> values_;
};

}  // namespace palpate::bench
