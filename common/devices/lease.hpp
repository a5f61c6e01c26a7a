#pragma once

namespace palpate {

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
