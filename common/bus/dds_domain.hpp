#pragma once
#include <memory>

#include "common/bus/dds_bus.hpp"

namespace palpate {

/// Keeps this process in the domain of these settings for as long as it lives; participants that are made meanwhile
/// join it. All who hold one share it. Throws std::runtime_error in one sentence where the middleware refuses, or this
/// process is in that domain with other settings already.
std::shared_ptr<const void> join_domain(const BusSettings& settings);

}  // namespace palpate
