#pragma once
#include <bit>
#include <concepts>
#include <cstring>

#include "common/bus/codec.hpp"
#include "common/bus/field_kinds.hpp"
#include "idl/fields.hpp"

/// What codec.hpp promises, to be instantiated where a type is at home.
namespace palpate {

static_assert(std::endian::native == std::endian::little, "the log encoding copies numbers as they lie in memory");

namespace detail {

struct Encoder {
  Bytes& out;

  void raw(const void* from, std::size_t size) {
    if (size == 0) return;
    const std::size_t end = out.size();
    out.resize(end + size);
    std::memcpy(out.data() + end, from, size);
  }
  void count(std::size_t n) {
    const auto value = static_cast<std::uint32_t>(n);
    raw(&value, sizeof value);
  }
  template <class T>
  void operator()(const char*, const T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      raw(&value, sizeof value);
    } else if constexpr (std::same_as<T, std::string>) {
      count(value.size());
      raw(value.data(), value.size());
    } else if constexpr (is_vector<T> || is_array<T>) {
      if constexpr (is_vector<T>) count(value.size());
      if constexpr (std::is_arithmetic_v<typename T::value_type>) {
        raw(value.data(), value.size() * sizeof(typename T::value_type));
      } else {
        for (const auto& element : value) (*this)("", element);
      }
    } else {
      fields(*this, value);
    }
  }
};

/// Bytes that an element takes at least.
template <class T>
std::size_t min_size() {
  if constexpr (std::is_arithmetic_v<T>) {
    return sizeof(T);
  } else if constexpr (std::same_as<T, std::string> || is_vector<T>) {
    return sizeof(std::uint32_t);
  } else if constexpr (is_array<T>) {
    return std::tuple_size_v<T> * min_size<typename T::value_type>();
  } else {
    std::size_t size = 0;
    T element;
    fields([&]<class Field>(const char*, const Field&) { size += min_size<Field>(); }, element);
    return size;
  }
}

/// Reads until the first thing that does not fit; then `good` is false and the rest of the message is
/// untouched.
struct Decoder {
  std::span<const std::uint8_t> in;
  bool good = true;

  void raw(void* to, std::size_t size) {
    good = good && size <= in.size();
    if (!good || size == 0) return;
    std::memcpy(to, in.data(), size);
    in = in.subspan(size);
  }
  /// A count whose elements, at their smallest, still fit into what is left.
  std::size_t count(std::size_t element_size) {
    std::uint32_t n = 0;
    raw(&n, sizeof n);
    good = good && n <= in.size() / element_size;
    return good ? n : 0;
  }
  template <class T>
  void operator()(const char*, T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      raw(&value, sizeof value);
    } else if constexpr (std::same_as<T, std::string>) {
      value.resize(count(1));
      raw(value.data(), value.size());
    } else if constexpr (is_vector<T> || is_array<T>) {
      using Element = typename T::value_type;
      if constexpr (is_vector<T>) value.resize(count(min_size<Element>()));
      if constexpr (std::is_arithmetic_v<Element>) {
        raw(value.data(), value.size() * sizeof(Element));
      } else {
        for (auto& element : value) (*this)("", element);
      }
    } else {
      fields(*this, value);
    }
  }
};

template <class T>
std::string type_name() {
  if constexpr (std::same_as<T, std::string>) {
    return "string";
  } else if constexpr (is_vector<T>) {
    return type_name<typename T::value_type>().append("[]");
  } else if constexpr (is_array<T>) {
    const std::string count = std::to_string(std::tuple_size_v<T>);
    return type_name<typename T::value_type>().append("[").append(count).append("]");
  } else if constexpr (std::is_arithmetic_v<T>) {
    const char* kind = std::is_floating_point_v<T> ? "f" : std::is_signed_v<T> ? "i" : "u";
    return std::string(kind).append(std::to_string(8 * sizeof(T)));
  } else {
    return name_of(static_cast<const T*>(nullptr));
  }
}

}  // namespace detail

template <class M>
void encode(const M& message, Bytes& out) {
  detail::Encoder{out}("", message);
}

template <class M>
bool decode(std::span<const std::uint8_t> bytes, M& message) {
  detail::Decoder decoder{bytes};
  decoder("", message);
  return decoder.good && decoder.in.empty();
}

template <class M>
std::string schema_line() {
  std::string line = name_of(static_cast<const M*>(nullptr));
  char separator = ':';
  M message;
  fields(
      [&]<class T>(const char* name, const T&) {
        line.append(1, separator).append(" ").append(name).append(" ").append(detail::type_name<T>());
        separator = ',';
      },
      message);
  return line.append("\n");
}

}  // namespace palpate
