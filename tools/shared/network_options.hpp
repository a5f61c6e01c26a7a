#pragma once
#include <string>

#include "common/bus/dds_bus.hpp"
#include "common/cli/command_line.hpp"
#include "common/scene/scene.hpp"

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

/// The network of a running system, which a scene file may tell.
struct SystemNetwork : BusSettings {
  std::string scene;
};

/// The same options, and --scene.
inline void add_system_options(cli::Command& command, SystemNetwork& network, const std::string& role) {
  command.add_option("--scene", network.scene,
                     "Scene file of the running system: its [network] holds where no other option says more");
  add_network_options(command, network, role);
}

/// Once the command line is read: what the scene says, if one is named, where no option does.
inline void take_scene(const cli::Command& command, SystemNetwork& network) {
  if (network.scene.empty()) return;
  const Network of_scene = load_scene(network.scene).network;
  if (!command.given("--domain")) network.domain = of_scene.domain;
  if (network.interface.empty()) network.interface = of_scene.interface;
  if (network.peers.empty()) network.peers = of_scene.peers;
  if (network.keys.empty() && of_scene.security) network.keys = of_scene.security->keys;
}

}  // namespace palpate
