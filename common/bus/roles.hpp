#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace palpate {

/// What a role may do on the bus: names of topics, in which * stands for anything.
struct Rights {
  std::vector<std::string> writes, reads;
};

/// Whoever joins the bus does so in one of these roles. haptic, deform, render, web, driver and recorder take part and
/// announce themselves; an observer reads all and writes nothing; a player writes what a log holds; latency measures
/// round trips over topics of its own and reads all.
const std::vector<std::string>& bus_roles();

/// The bit of a role that takes part (roles::Bit), 0 for the others.
std::uint32_t role_bit(const std::string& role);

/// The rights of a role by the writers and readers in the table of topics. Throws std::runtime_error for
/// a role that there is not.
Rights rights_of(const std::string& role);

}  // namespace palpate
