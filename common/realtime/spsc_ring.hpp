#pragma once
#include <atomic>
#include <bit>
#include <cstddef>
#include <vector>

namespace palpate {

/// Ring between one producer and one consumer thread. All slots are made at construction; neither side locks,
/// allocates or waits, so that the haptic step may push. A slot keeps its memory: vectors inside it keep
/// their capacity from lap to lap.
///
///     if (T* slot = ring.begin_push()) { fill(*slot); ring.commit_push(); } else ++lost;
///     if (T* slot = ring.begin_pop()) { use(*slot); ring.commit_pop(); }
template <class T>
class SpscRing {
 public:
  /// Capacity is rounded up to a power of two. Each slot is a copy of `slot`: reserve its vectors there, or
  /// in for_each_slot, since copying a vector does not copy its capacity.
  explicit SpscRing(std::size_t capacity, const T& slot = T())
      : slots_(std::bit_ceil(capacity < 2 ? std::size_t{2} : capacity), slot), mask_(slots_.size() - 1) {}

  /// Set-up only, before the threads start: prepares every slot.
  template <class F>
  void for_each_slot(F&& prepare) {
    for (T& slot : slots_) prepare(slot);
  }

  std::size_t capacity() const { return slots_.size(); }

  /// Producer: the slot to fill, null if the ring is full. Calling it again before commit_push gives the same
  /// slot.
  T* begin_push() {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_seen_ == slots_.size()) {
      tail_seen_ = tail_.load(std::memory_order_acquire);
      if (head - tail_seen_ == slots_.size()) return nullptr;
    }
    return &slots_[head & mask_];
  }
  void commit_push() { head_.store(head_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

  /// Producer: copies the value in; false if the ring is full.
  bool push(const T& value) {
    T* slot = begin_push();
    if (!slot) return false;
    *slot = value;
    commit_push();
    return true;
  }

  /// Consumer: the oldest slot, null if the ring is empty. It stays valid until commit_pop.
  T* begin_pop() {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_seen_) {
      head_seen_ = head_.load(std::memory_order_acquire);
      if (tail == head_seen_) return nullptr;
    }
    return &slots_[tail & mask_];
  }
  void commit_pop() { tail_.store(tail_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

  /// Consumer: copies the oldest value out; false if the ring is empty.
  bool pop(T& value) {
    const T* slot = begin_pop();
    if (!slot) return false;
    value = *slot;
    commit_pop();
    return true;
  }

 private:
  std::vector<T> slots_;
  std::size_t mask_;
  // Each side's counter and its last sight of the other's lie on a cache line of their own.
  alignas(64) std::atomic<std::size_t> head_{0};
  std::size_t tail_seen_ = 0;
  alignas(64) std::atomic<std::size_t> tail_{0};
  std::size_t head_seen_ = 0;
};

}  // namespace palpate
