#pragma once
#include <cmath>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/fem/constraint.hpp"

namespace palpate::testing {

/// Displacements of `count` touchable nodes spread over the surface, along their free axes.
inline std::vector<Constraint> spread_holds(const Archive& archive, int count) {
  std::vector<Constraint> holds;
  for (int i = 0; i < count; ++i) {
    const int k = static_cast<int>((i + 0.5) * archive.surface.touchable / count);
    for (int axis = 0; axis < 3; ++axis)
      if (!archive.surface.fixed[k][axis])
        holds.push_back(hold(archive.surface.node_number[k], axis, 1e-3 * std::sin(5.0 * i + 2.0 * axis + 1)));
  }
  return holds;
}

}  // namespace palpate::testing
