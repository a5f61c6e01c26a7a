#pragma once
#include <fmt/format.h>

#include <limits>
#include <string>
#include <vector>

#include "common/bus/field_kinds.hpp"
#include "idl/fields.hpp"
#include "idl/limits.hpp"

/// Every message spoilt in one field, for every field of every message in the IDL: its numbers at their extremes, its
/// texts empty, too long and not printable, its sequences empty and full.
namespace palpate::testing {

/// What a number can be that a program may not expect.
template <class T>
std::vector<T> extremes() {
  using Of = std::numeric_limits<T>;
  if constexpr (std::is_floating_point_v<T>)
    return {Of::quiet_NaN(), Of::infinity(), -Of::infinity(), Of::max(), Of::lowest(), T(0), T(1e11), T(-1e11)};
  else if constexpr (std::same_as<T, std::int64_t>)
    return {Of::min(), Of::max(), 0, -1, 2'000'000'000'000'000'000};
  else
    return {0, Of::max(), Of::max() / 2 + 1, Of::max() / 2, Of::max() - 1};
}

/// Calls play(name, message) for each; `message` is as it was after that.
template <class M, class Play>
class Mutations {
 public:
  Mutations(M& message, Play play) : message_(message), play_(std::move(play)) { fields(*this, message_); }

  template <class T>
  void operator()(const char* name, T& field) {
    const T before = field;
    const std::string path = path_ + "." + name;
    if constexpr (std::is_arithmetic_v<T>) {
      for (const T value : extremes<T>()) try_value(fmt::format("{} = {}", path, value), field, value);
    } else if constexpr (std::same_as<T, std::string>) {
      for (const char* text : {"", "\x1b[2J\x07 \xff\xfe", "haptic 1@nowhere"})
        try_value(path + " odd", field, T(text));
      try_value(path + " long", field, T(1000, 'x'));
    } else if constexpr (is_array<T>) {
      for (const auto value : extremes<typename T::value_type>()) {
        field.fill(value);
        play_(fmt::format("{} all {}", path, value), message_);
      }
    } else if constexpr (is_vector<T>) {
      vary(path, field);
    }
    field = before;
  }

 private:
  static constexpr std::size_t kLong = 5000;  // elements, where more would be allowed

  template <class T>
  void try_value(const std::string& name, T& field, T value) {
    field = std::move(value);
    play_(name, message_);
  }

  template <class T>
  void vary(const std::string& path, std::vector<T>& field) {
    const std::vector<T> before = field;
    field.clear();
    play_(path + " empty", message_);
    field.assign(kLong, before.empty() ? T{} : before.front());
    play_(path + " long", message_);
    field = before;
    if (field.empty()) field.resize(1);
    if constexpr (std::is_class_v<T>) {
      const std::string outer = std::exchange(path_, path + "[0]");
      fields(*this, field.front());
      path_ = outer;
    } else {
      (*this)((path.substr(path.rfind('.') + 1) + "[0]").c_str(), field.front());
    }
  }

  M& message_;
  Play play_;
  std::string path_ = name_of(&message_);
};

}  // namespace palpate::testing
