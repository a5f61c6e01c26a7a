#pragma once
#include <span>
#include <string_view>

namespace palpate {

/// Published properties of a tissue at rest and under small strains. People, ages and methods differ: the range is what
/// is found, `young` a value within it.
struct Tissue {
  std::string_view name;
  double young, young_low, young_high;  ///< [Pa]
  double poisson;                       ///< [1] nearly incompressible tissue is taken at 0.45
  double density;                       ///< [kg/m^3]
  std::string_view source;              ///< of the moduli
};

std::span<const Tissue> tissues();

/// Null where none has the name.
const Tissue* find_tissue(std::string_view name);

/// "liver, kidney, ..."
std::string_view tissue_names();

}  // namespace palpate
