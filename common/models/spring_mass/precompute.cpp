#include "common/models/moving/precompute.hpp"

#include "common/models/spring_mass/spec.hpp"

namespace palpate {

ArchiveJob archive_job(const SpringMassSpec& body, const Progress& progress) {
  return moving_archive_job(body, SpringMassSpec::kKind, progress);
}

}  // namespace palpate
