#pragma once
#include <string_view>

#include "common/dynamics/spec.hpp"
#include "common/models/kind.hpp"

namespace palpate {

/// Springs along the edges, their stiffness fitted to Young's modulus; for comparison (RR3510 sec. 5).
struct SpringMassSpec : MovingSpec {
  static constexpr std::string_view kKind = "spring_mass";
};

inline void describe(Description& d, SpringMassSpec& b) {
  describe(d, static_cast<MovingSpec&>(b));
  d.require(!b.dynamic.corotational, "dynamic.corotational",
            "corotational is for elements, and springs turn with the tissue by themselves");
}

ArchiveJob archive_job(const SpringMassSpec& body, const Progress& progress);

std::unique_ptr<DynamicOrgan> make_organ(const SpringMassSpec& body, const Archive& archive,
                                         const StepSettings& settings);

void check(const SpringMassSpec& body, const CheckSettings& settings, CheckReport& report);
/// Springs have a Poisson's ratio of their own.
inline std::vector<std::string> locking_warnings(const SpringMassSpec&) {
  return {};
}

}  // namespace palpate
