#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <string_view>
#include <type_traits>

namespace palpate {

/// An enumeration whose values have words in a scene file: words_of(value), found beside the enumeration, gives those
/// of its values from 0 on, in their order.
template <class E>
concept Choice = std::is_enum_v<E> && requires(E value) {
  {std::span<const std::string_view>(words_of(value))};
};

/// The word of a value that has one.
template <Choice E>
std::string_view word_of(E value) {
  return words_of(value)[static_cast<std::size_t>(value)];
}

/// The value of one of the words.
template <Choice E>
E value_of(std::string_view word) {
  const auto& words = words_of(E{});
  return static_cast<E>(std::ranges::find(words, word) - std::ranges::begin(words));
}

}  // namespace palpate
