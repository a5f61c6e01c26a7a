#include "common/models/moving/check.hpp"

#include <algorithm>
#include <iterator>

#include "common/models/hybrid/spec.hpp"

namespace palpate {

void check(const HybridSpec& body, const CheckSettings& settings, CheckReport& report) {
  const MovingKind kind{.name = HybridSpec::kKind,
                        .make_model = make_element_model,
                        .precompute = [&] { return archive_job(body, {})(); },
                        .own_mesh = !body.hybrid.mesh.empty()};
  check_moving(body, kind, settings, report);
  std::ranges::copy(locking_warnings(body), std::back_inserter(report.warnings));
}

}  // namespace palpate
