#pragma once
#include <string>

#include "common/bus/messages.hpp"

/// Which stream of a topic a message belongs to, and where it stands in it.
namespace palpate {

/// The key field as text; empty for messages without a key.
template <class M>
std::string key_of(const M& message) {
  if constexpr (requires {
                  message.node;
                  message.body;
                }) {
    return message.node + " " + std::to_string(message.body);
  } else if constexpr (requires { message.tool; }) {
    return std::to_string(message.tool);
  } else if constexpr (requires { message.body; }) {
    return std::to_string(message.body);
  } else if constexpr (requires { message.node; }) {
    return message.node;
  } else {
    return {};
  }
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
