#pragma once
#include <memory>

#include "common/bus/bus.hpp"

namespace palpate {

/// What the buses of several nodes in one process share.
class MemoryNetwork;
std::shared_ptr<MemoryNetwork> make_memory_network();

/// A bus in the memory of this process with the semantics of the network: keys, late joiners, validation.
/// A writer is alive as long as the object lives. Buses on one network may be used by different threads.
std::unique_ptr<Bus> make_memory_bus(std::shared_ptr<MemoryNetwork> network);

}  // namespace palpate
