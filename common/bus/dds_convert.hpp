#pragma once
#include <algorithm>
#include <cstring>

#include "common/bus/field_kinds.hpp"
#include "idl/dds_types.hpp"
#include "idl/fields.hpp"

/// Messages to and from the structs that idlc generates. Sequences and strings are lent to Cyclone DDS on the
/// way out and copied on the way in.
namespace palpate::dds {

/// Copies the text into a bounded string; what does not fit is cut before the character that it would split.
template <std::size_t n>
void clip(char (&to)[n], const std::string& from) {
  std::size_t length = std::min(from.size(), n - 1);
  if (length < from.size())
    while (length > 0 && (static_cast<unsigned char>(from[length]) & 0xC0) == 0x80) --length;
  std::memcpy(to, from.data(), length);
  to[length] = '\0';
}

struct Lend {
  template <class T, class C>
  void operator()(const char*, const T& from, C& to) const {
    if constexpr (std::is_arithmetic_v<T>) {
      static_assert(std::same_as<T, C>);
      to = from;
    } else if constexpr (is_array<T>) {
      static_assert(std::same_as<typename T::value_type, std::remove_extent_t<C>> && sizeof(T) == sizeof(C));
      std::memcpy(to, from.data(), sizeof to);
    } else if constexpr (std::same_as<T, std::string>) {
      if constexpr (std::is_array_v<C>) {
        clip(to, from);
      } else {
        to = const_cast<char*>(from.c_str());
      }
    } else {
      using Element = std::remove_pointer_t<decltype(to._buffer)>;
      static_assert(sizeof(Element) == sizeof(typename T::value_type));
      to._maximum = to._length = static_cast<std::uint32_t>(from.size());
      to._buffer = reinterpret_cast<Element*>(const_cast<typename T::value_type*>(from.data()));
      to._release = false;
    }
  }
};

struct CopyOut {
  template <class T, class C>
  void operator()(const char*, T& to, const C& from) const {
    if constexpr (std::is_arithmetic_v<T>) {
      to = from;
    } else if constexpr (is_array<T>) {
      std::memcpy(to.data(), from, sizeof from);
    } else if constexpr (std::same_as<T, std::string>) {
      const char* text = from;
      to = text ? text : "";
    } else {
      to.resize(from._length);
      if (from._length > 0)
        std::memcpy(static_cast<void*>(to.data()), from._buffer, from._length * sizeof(*from._buffer));
    }
  }
};

}  // namespace palpate::dds
