#pragma once
#include <string_view>

namespace palpate {

/// What the haptic node says of a tool whose lease is over.
inline constexpr std::string_view kDriverSilent = "a tool stands and its force fades: its driver elsewhere is silent";

/// How long a driver elsewhere may be silent: counted from its last new sample, by the clock of who hears it.
class Lease {
 public:
  explicit Lease(double seconds) : length_(seconds) {}

  void heard(double now) { heard_ = now; }
  bool over(double now) const { return now - heard_ > length_; }

 private:
  double length_;
  double heard_ = 0;
};

}  // namespace palpate
