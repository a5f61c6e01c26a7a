#pragma once
#include "common/describe/description.hpp"

namespace palpate {

/// Watch over the energy that all tools together take from the tissue.
struct Passivity {
  bool controller = true;  ///< damps the tools that take out more than they put in and the reserve; false: observes
  double reserve = 0.01;   ///< [J] that may be taken out beyond what was put in
};

inline void describe(Description& d, Passivity& p) {
  d.flag({"controller", "",
          "damps the tools that would take more energy out of the tissue than they put in and the reserve; false: the "
          "energy is observed only"},
         p.controller);
  d.number({"reserve", "J", "energy that may be taken out beyond what was put in"}, p.reserve, at_least(0));
}

}  // namespace palpate
