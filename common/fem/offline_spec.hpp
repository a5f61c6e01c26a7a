#pragma once
#include <string>

#include "common/describe/description.hpp"

namespace palpate {

/// What `precompute` takes the tensors from, where that is better than the body's own mesh. Run time sees the same
/// surface and the same number of tensors.
struct Offline {
  int refine = 0;                            ///< times that every tetrahedron is split into eight
  std::string element = "p1";                ///< p1 | p2: linear or quadratic displacement
  std::string formulation = "displacement";  ///< displacement | locking_free
};

inline void describe(Description& d, Offline& o) {
  d.integer({"refine", "", "times that every tetrahedron is split into eight", Need::optional, Use::stored}, o.refine,
            0, 2);
  d.choice({"element", "", "linear or quadratic displacement", Need::optional, Use::stored}, o.element, {"p1", "p2"});
  d.choice(
      {"formulation", "", "`\"locking_free\"` is for nearly incompressible tissue; with `\"p1\"` it needs `refine` ≥ 1",
       Need::optional, Use::stored},
      o.formulation, {"displacement", "locking_free"});
}

}  // namespace palpate
