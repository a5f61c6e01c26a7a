#pragma once
#include <vector>

#include "tools/latency/ways.hpp"

namespace palpate::latency {

/// Medians there and back [us] of a turn, one number a turn, in their order: in each turn every program has the host to
/// itself for o.seconds.
struct DdsperfTurns {
  std::vector<double> bus, listener, ddsperf;
};

/// o.ddsperf_turns turns of the bus, of bare DDS by listener and of the vendor's ddsperf in its own listener mode, with
/// messages as long and as often, between two processes of this host. Throws std::runtime_error where ddsperf is not
/// installed or prints no round trips, Interrupted after a signal.
DdsperfTurns beside_ddsperf(const LatencyOptions& o);

}  // namespace palpate::latency
