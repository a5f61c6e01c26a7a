#pragma once
#include <concepts>
#include <cstring>
#include <string>
#include <tuple>
#include <type_traits>

#include "common/bus/codec.hpp"
#include "common/bus/field_kinds.hpp"
#include "idl/fields.hpp"

/// Messages in the OMG's Common Data Representation (XTypes 1.3, encoding version 1, little-endian, final types), as
/// DDS sends them, and their types in IDL: what other programs read them with.
namespace palpate::cdr {

struct Encoder {
  Bytes& out;

  static constexpr std::size_t kHead = 4;  // what is aligned counts from behind it
  void align(std::size_t size) {
    while ((out.size() - kHead) % size != 0) out.push_back(0);
  }
  void raw(const void* from, std::size_t size) {
    const auto* first = static_cast<const std::uint8_t*>(from);
    out.insert(out.end(), first, first + size);
  }
  void count(std::size_t n) { (*this)("", static_cast<std::uint32_t>(n)); }

  template <class T>
  void operator()(const char*, const T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      align(sizeof value);
      raw(&value, sizeof value);
    } else if constexpr (std::same_as<T, std::string>) {
      count(value.size() + 1);
      raw(value.c_str(), value.size() + 1);
    } else if constexpr (is_vector<T> || is_array<T>) {
      if constexpr (is_vector<T>) count(value.size());
      for (const auto& element : value) (*this)("", element);
    } else {
      fields(*this, value);
    }
  }
};

/// The message behind the four bytes that name the encoding.
template <class M>
void encode(const M& message, Bytes& out) {
  out = {0, 1, 0, 0};
  Encoder{out}("", message);
}

namespace detail {

template <class T>
std::string simple_name() {
  if constexpr (std::same_as<T, std::string>) return "string";
  if constexpr (std::same_as<T, float>) return "float";
  if constexpr (std::same_as<T, double>) return "double";
  if constexpr (std::is_integral_v<T> && sizeof(T) == 1) return "octet";
  if constexpr (std::is_integral_v<T>) {
    const std::string name = sizeof(T) == 8 ? "long long" : sizeof(T) == 4 ? "long" : "short";
    return std::is_signed_v<T> ? name : std::string("unsigned ").append(name);
  }
  return {};
}

template <class T>
inline constexpr bool is_simple = std::is_arithmetic_v<T> || std::same_as<T, std::string>;

template <class T>
std::string type_name() {
  if constexpr (is_simple<T>)
    return simple_name<T>();
  else
    return name_of(static_cast<const T*>(nullptr));
}

template <class T>
std::string member(const std::string& name) {
  if constexpr (is_vector<T>)
    return std::string("sequence<").append(type_name<typename T::value_type>()).append("> ").append(name);
  else if constexpr (is_array<T>)
    return type_name<typename T::value_type>().append(" ").append(name).append("[").append(
        std::to_string(std::tuple_size_v<T>) + "]");
  else
    return type_name<T>().append(" ").append(name);
}

/// Appends the struct, those that it is made of first, each once.
template <class M>
void add_struct(std::string& idl) {
  std::string text;
  const auto add = [&]<class T>(const char* name, const T&) {
    using Element = typename decltype([] {
      if constexpr (is_vector<T> || is_array<T>)
        return std::type_identity<typename T::value_type>();
      else
        return std::type_identity<T>();
    }())::type;
    if constexpr (!is_simple<Element>) add_struct<Element>(idl);
    text.append("    ").append(member<T>(name)).append(";\n");
  };
  M message;
  fields(add, message);
  const std::string head = "  @final struct " + type_name<M>() + " {\n";
  if (idl.find(head) == idl.npos) idl.append(head).append(text).append("  };\n");
}

}  // namespace detail

/// IDL of a message and of all that it is made of.
template <class M>
std::string idl() {
  std::string text;
  detail::add_struct<M>(text);
  return "module palpate {\n" + text + "};\n";
}

}  // namespace palpate::cdr
