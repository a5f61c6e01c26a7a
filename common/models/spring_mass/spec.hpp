#pragma once
#include <string_view>

#include "common/models/moving_kind.hpp"

namespace palpate {

/// Springs along the edges, their stiffness fitted to Young's modulus; for comparison (RR3510 sec. 5).
struct SpringMassSpec : MovingSpec {
  static constexpr std::string_view kKind = "spring_mass";
};

inline void describe(Description& d, SpringMassSpec& b) {
  describe(d, static_cast<MovingSpec&>(b));
  d.require(!b.dynamic.corotational, "dynamic.corotational",
            "corotational is for elements, and springs turn with the tissue by themselves");
  d.require(b.dynamic.element == TetElement::linear, "dynamic.element",
            "nodal_strain is for elements, and springs have no strain to average");
}

std::unique_ptr<DynamicModel> make_model(const SpringMassSpec& body, const ElasticMesh& mesh);

FreeVibration vibration(const SpringMassSpec& body);

/// Throws: the full system is one of elements, of which springs know nothing.
DirectProblem direct_problem(const SpringMassSpec& body);

/// Springs have a Poisson's ratio of their own.
inline std::vector<std::string> locking_warnings(const SpringMassSpec&) {
  return {};
}

}  // namespace palpate
