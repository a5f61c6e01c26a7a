#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>

#include "idl/messages.hpp"

namespace palpate {

/// What a body in the haptic step may tell beside its contacts: a row for each message of a kind of tissue. Every one
/// has body, run, seq, step and sense_ns.
using BodyMessage = std::variant<ModalState, CatheterState, TaskRecord, CreepState>;

inline constexpr std::uint32_t kInJaws = 2;         ///< HeldContact::sticking of what is between jaws
inline constexpr std::uint64_t kShapeInterval = 4;  ///< [steps] from one shape of a body to the next

/// A message of a body and how often it is told.
struct BodyNews {
  BodyMessage message;
  std::uint64_t interval = kShapeInterval;  ///< [steps] from one to the next
  bool to_the_end = false;                  ///< filled in every step, and told once more when the loop ends

  bool due(std::uint64_t step) const { return step % interval == 0; }
};

/// Calls f with an empty message of each type.
template <class F>
void for_each_body_message(F&& f) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (f(std::variant_alternative_t<I, BodyMessage>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<BodyMessage>>{});
}

/// Which body a message is of, by its place in the scene.
inline std::uint32_t body_of(const BodyMessage& message) {
  return std::visit([](const auto& m) { return m.body; }, message);
}

}  // namespace palpate
