#include "common/models/moving/check.hpp"

#include <algorithm>
#include <iterator>

#include "common/models/tensor_mass/spec.hpp"

namespace palpate {

void check(const TensorMassSpec& body, const CheckSettings& settings, CheckReport& report) {
  const MovingKind kind{.name = TensorMassSpec::kKind, .make_model = make_element_model, .precompute = [&] {
                          return archive_job(body, {})();
                        }};
  check_moving(body, kind, settings, report);
  std::ranges::copy(locking_warnings(body), std::back_inserter(report.warnings));
}

}  // namespace palpate
