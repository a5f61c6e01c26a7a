#pragma once
#include <memory>

#include "common/bus/dds_bus.hpp"
#include "common/cli/command_line.hpp"

namespace palpate {

/// Adds --domain, --interface, --peer and --keys for commands that join a running system without a scene file.
/// `role`: the one they take among its keys.
inline void add_network_options(cli::Command& command, BusSettings& settings, const std::string& role) {
  settings.role = role;
  command.add_option("--domain", settings.domain, "DDS domain of the running system").between(0, 230).show_default();
  command.add_option("--interface", settings.interface, "Network interface, name or address (default: loopback)");
  command.add_option("--peer", settings.peers, "Host to ask for other nodes; may be repeated");
  command.add_option("--keys", settings.keys, "Folder of keys, where the system's scene has [network.security]");
}

}  // namespace palpate
