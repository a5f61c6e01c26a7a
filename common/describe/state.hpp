#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

namespace palpate {

/// A visitor over what an object remembers from step to step. Each object has one function `state(State&)` that names
/// its pieces in order; measuring, saving and restoring are the same walk. Never allocates.
class State {
 public:
  static State measure() { return State(nullptr, nullptr); }
  static State save(std::uint8_t* to) { return State(to, nullptr); }
  static State restore(const std::uint8_t* from) { return State(nullptr, from); }

  bool restoring() const { return from_ != nullptr; }
  std::size_t size() const { return size_; }  ///< [bytes] walked so far

  /// Plain memory, or a vector or matrix of a fixed size.
  template <class T>
  void value(T& v) {
    static_assert(std::is_trivially_copyable_v<T> || std::is_base_of_v<Eigen::PlainObjectBase<T>, T>);
    bytes(&v, sizeof v);
  }
  /// Plain memory of a number of entries that never changes.
  template <class Range>
  void all(Range&& values) {
    bytes(values.data(), values.size() * sizeof(values[0]));
  }
  void bytes(void* data, std::size_t count) {
    size_ += count;
    if (count == 0) return;
    if (to_) std::memcpy(std::exchange(to_, to_ + count), data, count);
    if (from_) std::memcpy(data, std::exchange(from_, from_ + count), count);
  }
  /// Leaves out `count` bytes: room that is kept for later.
  void skip(std::size_t count) {
    size_ += count;
    if (to_) std::memset(std::exchange(to_, to_ + count), 0, count);
    if (from_) from_ += count;
  }
  /// What has been restored must be good.
  void require(bool good, const char* sentence) const {
    if (restoring() && !good) throw std::runtime_error(sentence);
  }

 private:
  State(std::uint8_t* to, const std::uint8_t* from) : to_(to), from_(from) {}

  std::uint8_t* to_;
  const std::uint8_t* from_;
  std::size_t size_ = 0;
};

/// state_size(), save() and restore() of an object with a function state(State&).
template <class Object>
class Stateful {
 public:
  std::size_t state_size() const {
    State s = State::measure();
    self().state(s);
    return s.size();
  }
  void save(std::uint8_t* to) const {
    State s = State::save(to);
    self().state(s);
  }
  /// `context`: what else state() wants to know where it restores.
  template <class... Context>
  void restore(const std::uint8_t* from, const Context&... context) {
    State s = State::restore(from);
    self().state(s, context...);
  }

 private:
  // One walk serves all: it changes nothing unless it restores.
  Object& self() const { return const_cast<Object&>(static_cast<const Object&>(*this)); }
};

}  // namespace palpate
