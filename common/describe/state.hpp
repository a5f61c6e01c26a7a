#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/describe/hash64.hpp"

namespace palpate {

/// A visitor over what an object remembers from step to step. Each object has one function `state(State&)` that names
/// its pieces in order; measuring, saving, hashing and restoring are the same walk. Lists apart, it never allocates.
class State {
 public:
  static constexpr const char* kOfAnother = "the recorded state is of another body";

  static State measure() { return {}; }
  /// Into room that has been measured.
  static State save(std::uint8_t* to) {
    State s;
    s.to_ = to;
    return s;
  }
  /// Into bytes that grow.
  static State save(std::vector<std::uint8_t>& to) {
    State s;
    s.grown_ = &to;
    return s;
  }
  static State hash(Hash64& to) {
    State s;
    s.hash_ = &to;
    return s;
  }
  /// From what has the measured size.
  static State restore(const std::uint8_t* from) {
    State s;
    s.restoring_ = true;
    s.from_ = from;
    return s;
  }
  /// From bytes that may be cut short: then std::runtime_error is thrown.
  static State restore(std::span<const std::uint8_t> from) {
    State s = restore(from.data());
    s.left_ = from.size();
    return s;
  }

  bool restoring() const { return restoring_; }
  std::size_t size() const { return size_; }  ///< [bytes] walked so far

  /// Plain memory, or a vector or matrix of a fixed size.
  template <class T>
  void value(T& v) {
    static_assert(std::is_trivially_copyable_v<T> || std::is_base_of_v<Eigen::PlainObjectBase<T>, T>);
    if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = v;  // another byte than 0 and 1 is no bool
      bytes(&byte, 1);
      v = byte != 0;
    } else {
      clear_padding(v);
      bytes(&v, sizeof v);
    }
  }
  /// Plain memory of a number of entries that never changes.
  template <class Range>
  void all(Range&& values) {
    for (auto& v : values) clear_padding(v);
    bytes(values.data(), values.size() * sizeof(values[0]));
  }
  /// A list of any length.
  template <class T>
  void list(std::vector<T>& values) {
    std::uint64_t count = values.size();
    value(count);
    if (restoring_) {
      if (count > left_ / sizeof(T)) throw_short();
      values.resize(count);
    }
    for (T& v : values) clear_padding(v);
    bytes(values.data(), count * sizeof(T));
  }
  void bytes(void* data, std::size_t count) {
    size_ += count;
    if (count == 0) return;
    if (to_) std::memcpy(std::exchange(to_, to_ + count), data, count);
    if (hash_) hash_->add_bytes(data, count);
    if (grown_) {
      const auto* first = static_cast<const std::uint8_t*>(data);
      grown_->insert(grown_->end(), first, first + count);
    }
    if (restoring_) std::memcpy(data, take(count), count);
  }
  /// Leaves out `count` bytes: room that is kept for later.
  void skip(std::size_t count) {
    size_ += count;
    if (to_) std::memset(std::exchange(to_, to_ + count), 0, count);
    if (grown_) grown_->resize(grown_->size() + count, 0);
    if (restoring_) take(count);
  }
  /// A number, as of a list that never changes its length, that must be what it was.
  void same(std::uint64_t number) {
    const std::uint64_t own = number;
    value(number);
    require(number == own, kOfAnother);
  }
  /// What has been restored must be good.
  void require(bool good, const char* sentence) const {
    if (restoring() && !good) throw std::runtime_error(sentence);
  }

 private:
  State() = default;
  /// Between the members of a struct may be room that holds anything: equal objects shall give equal bytes. (Only GCC
  /// can do it.)
  template <class T>
  static void clear_padding([[maybe_unused]] T& v) {
#if __has_builtin(__builtin_clear_padding)
    if constexpr (std::is_trivially_copyable_v<T> && !std::is_scalar_v<T>) __builtin_clear_padding(&v);
#endif
  }
  [[noreturn]] static void throw_short() {
    throw std::runtime_error("the recorded state is cut short, or of another version of palpate");
  }
  const std::uint8_t* take(std::size_t count) {
    if (count > left_) throw_short();
    left_ -= count;
    return std::exchange(from_, from_ + count);
  }

  bool restoring_ = false;
  std::uint8_t* to_ = nullptr;
  std::vector<std::uint8_t>* grown_ = nullptr;
  Hash64* hash_ = nullptr;
  const std::uint8_t* from_ = nullptr;
  std::size_t left_ = std::numeric_limits<std::size_t>::max();  ///< [bytes] that may be taken
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
