#pragma once
#include "common/models/moving/dynamic_organ.hpp"

namespace palpate::drive {

/// Into what a body that can be cut has come apart.
struct Pieces {
  int count = 0;        ///< a hybrid body's quasi-static part counts with all that hangs on it
  int largest_off = 0;  ///< tetrahedra of the largest piece but for the one that hangs on that part, or is the largest
};
Pieces pieces_of(const DynamicOrgan& organ);

}  // namespace palpate::drive
