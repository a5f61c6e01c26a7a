#pragma once
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "common/bus/field_kinds.hpp"
#include "idl/fields.hpp"

/// Messages as text for people and scripts. Numbers are written so that reading them back gives the same
/// value.
namespace palpate {

/// A JSON string with its quotes.
inline std::string json_string(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      out += c;
    }
  }
  return out.append("\"");
}

/// A message, or a field of one, as JSON; numbers that JSON does not know become null.
template <class T>
std::string to_json(const T& value) {
  if constexpr (std::same_as<T, std::string>) {
    return json_string(value);
  } else if constexpr (std::is_floating_point_v<T>) {
    return std::isfinite(value) ? fmt::format("{}", value) : "null";
  } else if constexpr (std::is_arithmetic_v<T>) {
    return std::to_string(value);
  } else if constexpr (is_vector<T> || is_array<T>) {
    std::string out = "[";
    for (const auto& element : value) out.append(out.size() > 1 ? "," : "").append(to_json(element));
    return out.append("]");
  } else {
    std::string out = "{";
    fields(
        [&](const char* name, const auto& field) {
          out.append(out.size() > 1 ? "," : "").append(json_string(name)).append(":").append(to_json(field));
        },
        value);
    return out.append("}");
  }
}

/// Column names of csv_row: arrays become name_0, name_1, …; a sequence is one column.
template <class M>
std::string csv_header() {
  std::string out;
  M message;
  fields(
      [&]<class T>(const char* name, const T& field) {
        const auto column = [&](const std::string& text) { out.append(out.empty() ? "" : ",").append(text); };
        if constexpr (is_array<T>) {
          for (std::size_t i = 0; i < field.size(); ++i) column(fmt::format("{}_{}", name, i));
        } else {
          column(name);
        }
      },
      message);
  return out;
}

/// One line of CSV (RFC 4180), without the line's end; sequences are quoted JSON.
template <class M>
std::string csv_row(const M& message) {
  std::string out;
  bool first = true;
  const auto column = [&](const std::string& text) {
    out.append(first ? "" : ",").append(text);
    first = false;
  };
  const auto quoted = [](const std::string& text) {
    std::string q = "\"";
    for (const char c : text) q.append(c == '"' ? 2 : 1, c);
    return q.append("\"");
  };
  fields(
      [&]<class T>(const char*, const T& field) {
        if constexpr (is_array<T>) {
          for (const auto& element : field) column(to_json(element));
        } else if constexpr (std::same_as<T, std::string>) {
          column(quoted(field));
        } else if constexpr (is_vector<T>) {
          column(quoted(to_json(field)));
        } else {
          column(to_json(field));
        }
      },
      message);
  return out;
}

}  // namespace palpate
