#pragma once
#include <array>
#include <string_view>

#include "common/describe/description.hpp"

namespace palpate {

/// What a tool's part touches with: a patch of pressures of its own; the touched point; or the three nodes of its
/// triangle (TVCG99 sec. 5).
enum class ContactRule { patch, barycentric, alpha };

inline const auto& words_of(ContactRule) {
  static constexpr std::array<std::string_view, 3> words{"patch", "barycentric", "alpha"};
  return words;
}

/// The law of contact.
struct ContactSpec {
  ContactRule rule = ContactRule::patch;
  double friction = 0.3;   ///< [1] Coulomb coefficient; 0 slides freely
  double bucket_size = 0;  ///< [m] 0: twice the mean edge length of the surface
};

inline void describe(Description& d, ContactSpec& c) {
  d.choice({"rule", "",
            "`\"patch\"` spreads the pressure of a probe's tip over squares of its own, on solid bodies, and "
            "that of shafts where such a body does not relax, so that the mesh is not felt; all "
            "else touches as under `\"barycentric\"`, which holds the touched point; "
            "`\"alpha\"` holds the three nodes of its triangle, for comparison, where tissue is not moving of itself"},
           c.rule);
  d.number({"friction", "1", "Coulomb's coefficient; 0 slides freely"}, c.friction, at_least(0));
  d.number({"bucket_size", "m", "edge of the collision grid's cells; 0 means twice the surface's mean edge length"},
           c.bucket_size, at_least(0));
}

}  // namespace palpate
