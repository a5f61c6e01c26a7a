#include "common/models/moving/check.hpp"

#include "common/models/spring_mass/spec.hpp"

namespace palpate {

void check(const SpringMassSpec& body, const CheckSettings& settings, CheckReport& report) {
  const MovingKind kind{.name = SpringMassSpec::kKind, .make_model = make_spring_model, .precompute = [&] {
                          return archive_job(body, {})();
                        }};
  check_moving(body, kind, settings, report);
}

}  // namespace palpate
