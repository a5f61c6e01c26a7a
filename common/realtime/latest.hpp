#pragma once
#include <array>
#include <atomic>

namespace palpate {

/// Hands the newest value from one thread to another without locks: three slots, one exchanged atomically. The
/// reader never waits for the writer nor the writer for the reader.
template <class T>
class Latest {
 public:
  /// Writer's side.
  void put(const T& value) {
    slots_[back_] = value;
    back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & ~kFresh;
  }
  /// Reader's side: the newest value; the last one again if nothing has come since.
  const T& get() {
    if (middle_.load(std::memory_order_relaxed) & kFresh)
      front_ = middle_.exchange(front_, std::memory_order_acq_rel) & ~kFresh;
    return slots_[front_];
  }

 private:
  static constexpr int kFresh = 4;
  std::array<T, 3> slots_{};
  int back_ = 0, front_ = 1;
  std::atomic<int> middle_{2};
};

}  // namespace palpate
