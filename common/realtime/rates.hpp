#pragma once
#include "common/describe/description.hpp"

namespace palpate {

struct Rates {
  double haptic_hz = 1000;
  double visual_hz = 60;
};

inline void describe(Description& d, Rates& r) {
  d.number({"haptic_hz", "Hz", "force loop"}, r.haptic_hz, within(1, 20000));
  d.number({"visual_hz", "Hz", "least rate of deformed surfaces and pictures"}, r.visual_hz, within(1, 1000));
}

}  // namespace palpate
