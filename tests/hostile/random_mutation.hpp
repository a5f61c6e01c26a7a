#pragma once
#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "common/bus/field_kinds.hpp"
#include "idl/fields.hpp"
#include "tests/hostile/mutations.hpp"

namespace palpate::testing {

/// Spoils a message in some of its fields, drawn by chance from all that the IDL gives it: each number of them nudged,
/// drawn anew or at an extreme, each text garbled, each sequence cut, repeated or filled, and within.
class RandomMutation {
 public:
  explicit RandomMutation(std::mt19937_64& random) : random_(random) {}

  template <class M>
  void spoil(M& message) {
    int all = 0;
    fields([&](const char*, auto&) { ++all; }, message);
    share_ = 1.5 / all;
    fields(*this, message);
  }

  template <class T>
  void operator()(const char*, T& field) {
    if constexpr (is_vector<T>) {
      if (chance(share_)) resize(field);
      if (!field.empty() && chance(4 * share_)) within(field[below(field.size())]);
    } else if (chance(share_)) {
      change(field);
    }
  }

 private:
  static constexpr std::size_t kLong = 600;  // elements of a sequence that is filled

  bool chance(double share) { return std::uniform_real_distribution<>()(random_) < share; }
  std::size_t below(std::size_t end) { return random_() % end; }

  template <class T>
  void within(T& element) {
    if constexpr (std::is_class_v<T>)
      fields(*this, element);
    else
      change(element);
  }

  template <class T>
  void change(T& field) {
    if constexpr (std::is_arithmetic_v<T>) {
      draw(field);
    } else if constexpr (is_array<T>) {
      draw(field[below(field.size())]);
    } else if constexpr (std::same_as<T, std::string>) {
      if (field.empty() || chance(0.3)) field.resize(below(1200), 'x');
      for (std::size_t k = 0; k < field.size() && k < 3; ++k) field[below(field.size())] = static_cast<char>(random_());
    }
  }

  template <class T>
  void draw(T& number) {
    switch (below(4)) {
      case 0:
        number = any_of(extremes<T>());
        break;
      case 1:
        random_bits(number);
        break;
      case 2:
        nudge(number);
        break;
      default:
        number = static_cast<T>(below(20));
    }
  }
  template <class T>
  void random_bits(T& number) {
    const std::uint64_t bits = random_();
    std::memcpy(&number, &bits, sizeof number);
  }
  template <class T>
  void nudge(T& number) {
    if constexpr (std::is_floating_point_v<T>)
      number = number * std::normal_distribution<>(1, 0.5)(random_) + std::normal_distribution<>(0, 0.01)(random_);
    else
      number = static_cast<T>(static_cast<std::uint64_t>(number) + below(5) - 2);
  }
  template <class T>
  T any_of(const std::vector<T>& values) {
    return values[below(values.size())];
  }
  template <class T>
  void resize(std::vector<T>& field) {
    const T like = field.empty() ? T{} : field[below(field.size())];
    field.resize(chance(0.5) ? below(field.size() + 2) : below(kLong), like);
  }

  std::mt19937_64& random_;
  double share_ = 0;
};

}  // namespace palpate::testing
