#pragma once
#include <cstdint>

namespace palpate {

/// When moving tissue is, and how late that is: idl/palpate.idl.
struct TissueTime {
  std::int64_t tissue_ns = 0;  ///< [ns] of its own time
  std::int64_t late_ns = 0;    ///< [ns] by which that is behind the time of its node's clock
};

/// Writes it into a message.
template <class M>
void stamp(const TissueTime& time, M& message) {
  message.tissue_ns = time.tissue_ns;
  message.late_ns = time.late_ns;
}

}  // namespace palpate
