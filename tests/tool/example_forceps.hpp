#pragma once
#include "common/tool/forceps.hpp"

namespace palpate::testing {

inline const ForcepsShape kForceps{
    .shaft_radius = 0.0025, .shaft_length = 0.3, .jaw_length = 0.015, .jaw_radius = 0.001};

}  // namespace palpate::testing
