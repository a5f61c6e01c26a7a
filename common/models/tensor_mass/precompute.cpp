#include "common/models/moving/precompute.hpp"

#include "common/models/tensor_mass/spec.hpp"

namespace palpate {

ArchiveJob archive_job(const TensorMassSpec& body, const Progress& progress) {
  return moving_archive_job(body, TensorMassSpec::kKind, progress);
}

}  // namespace palpate
