#pragma once
#include "common/realtime/clock.hpp"

namespace palpate {

/// Fills in when a sample is handed to the bus, where whoever wrote it has not.
template <class Sample>
void stamp(Sample& sample) {
  if constexpr (requires { sample.publish_ns; })
    if (sample.publish_ns == 0) sample.publish_ns = now_ns();
}

}  // namespace palpate
