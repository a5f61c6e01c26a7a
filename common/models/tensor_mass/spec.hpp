#pragma once
#include <string_view>

#include "common/dynamics/spec.hpp"
#include "common/models/kind.hpp"

namespace palpate {

/// Linear elasticity with lumped masses, one step after another (RR3510 sec. 5).
struct TensorMassSpec : MovingSpec {
  static constexpr std::string_view kKind = "tensor_mass";
};

inline void describe(Description& d, TensorMassSpec& b) {
  describe(d, static_cast<MovingSpec&>(b));
}

ArchiveJob archive_job(const TensorMassSpec& body, const Progress& progress);

void check(const TensorMassSpec& body, const CheckSettings& settings, CheckReport& report);

}  // namespace palpate
