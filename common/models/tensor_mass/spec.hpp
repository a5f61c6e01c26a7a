#pragma once
#include <string_view>

#include "common/models/moving_kind.hpp"

namespace palpate {

/// Linear elasticity with lumped masses, one step after another (RR3510 sec. 5).
struct TensorMassSpec : MovingSpec {
  static constexpr std::string_view kKind = "tensor_mass";
};

inline void describe(Description& d, TensorMassSpec& b) {
  describe(d, static_cast<MovingSpec&>(b));
}

constexpr bool contact_is_tried(const TensorMassSpec&) {
  return true;
}

}  // namespace palpate
