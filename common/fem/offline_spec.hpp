#pragma once
#include <array>
#include <string_view>

#include "common/describe/description.hpp"

namespace palpate {

/// Linear or quadratic displacement.
enum class FiniteElement { p1, p2 };

inline const auto& words_of(FiniteElement) {
  static constexpr std::array<std::string_view, 2> words{"p1", "p2"};
  return words;
}

/// Displacement alone, or with pressures of its own for nearly incompressible tissue.
enum class Formulation { displacement, locking_free };

inline const auto& words_of(Formulation) {
  static constexpr std::array<std::string_view, 2> words{"displacement", "locking_free"};
  return words;
}

/// What `precompute` takes the tensors from, where that is better than the body's own mesh. Run time sees the same
/// surface and the same number of tensors.
struct Offline {
  int refine = 0;  ///< times that every tetrahedron is split into eight
  FiniteElement element = FiniteElement::p1;
  Formulation formulation = Formulation::displacement;
};

inline void describe(Description& d, Offline& o) {
  d.integer({"refine", "", "times that every tetrahedron is split into eight", Need::optional, Use::stored}, o.refine,
            0, 2);
  d.choice({"element", "", "linear or quadratic displacement", Need::optional, Use::stored}, o.element);
  d.choice(
      {"formulation", "", "`\"locking_free\"` is for nearly incompressible tissue; with `\"p1\"` it needs `refine` ≥ 1",
       Need::optional, Use::stored},
      o.formulation);
}

}  // namespace palpate
