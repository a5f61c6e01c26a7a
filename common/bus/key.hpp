#pragma once
#include <string>

#include "idl/fields.hpp"

/// Which stream of a topic a message belongs to, and where it stands in it.
namespace palpate {

/// The keys as text; empty for messages without one.
template <class M>
std::string key_of(const M& message) {
  std::string text;
  key_fields(
      [&]<class Key>(const Key& key) {
        if (!text.empty()) text += ' ';
        if constexpr (std::same_as<Key, std::string>)
          text += key;
        else
          text += std::to_string(key);
      },
      message);
  return text;
}

/// Start of the loop that wrote the message, 0 where the message does not say.
template <class M>
std::uint64_t run_of(const M& message) {
  if constexpr (requires { message.run; }) return message.run;
  return 0;
}

/// When the data began its way, on the writer's clock [ns]; 0 where the message does not say.
template <class M>
std::int64_t sense_of(const M& message) {
  if constexpr (requires { message.sense_ns; }) return message.sense_ns;
  return 0;
}

}  // namespace palpate
