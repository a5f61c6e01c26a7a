#pragma once
#include <cstdint>
#include <string>

#include "idl/messages.hpp"

namespace palpate {

/// How the time of moving tissue goes, by what its messages say of it. From a running system or from a log.
class TissueCourse {
 public:
  void add(const SurfaceState& m) { look(m.tissue_ns, m.late_ns); }
  void add(const DeformStep& m) { look(m.tissue_ns, m.late_ns); }
  void begin_anew();  ///< what was lost before is not counted

  bool known() const { return tissue_ns_ > 0; }                                 ///< tissue moves
  double time_s() const { return 1e-9 * static_cast<double>(tissue_ns_); }      ///< [s] the tissue's own
  double late_s() const { return 1e-9 * static_cast<double>(late_ns_); }        ///< [s] by which that is late
  double lost_s() const { return 1e-9 * static_cast<double>(lost_ns_); }        ///< [s] of it since begin_anew()
  double at_once_s() const { return 1e-9 * static_cast<double>(at_once_ns_); }  ///< [s] the most from one to the next

 private:
  void look(std::int64_t tissue_ns, std::int64_t late_ns);

  std::int64_t tissue_ns_ = 0, late_ns_ = 0, lost_ns_ = 0, at_once_ns_ = 0;
};

/// In a line; empty where no tissue moves.
std::string text_of(const TissueCourse& tissue);

}  // namespace palpate
