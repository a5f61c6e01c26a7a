#pragma once
#include "idl/messages.hpp"

namespace palpate {

/// A haptic node that ends under a force goes on until it has faded as for a silent driver, no longer than this [s].
constexpr double kMaxLeaving = 0.2;
/// What its last steps are flagged with then, which is no intervention: other nodes end too.
constexpr std::uint32_t kOfLeaving = silent_device | stale_model;

}  // namespace palpate
