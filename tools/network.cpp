#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "common/node/node_setup.hpp"
#include "tools/shared/commands.hpp"

namespace palpate {
namespace {

void print_network(const NodeOptions& o) {
  const BusSettings settings = bus_settings(load_scene(o.scene), o, "driver");
  fmt::print("{}\n", dds_configuration(settings));
  std::fflush(stdout);
  fmt::print(stderr, "{}\n", dds_place(settings));
  if (!settings.keys.empty())
    fmt::print(stderr, "who takes part also needs the keys of a role, as docs/security.md tells\n");
}

}  // namespace

void add_network_command(cli::Command& app) {
  auto o = std::make_shared<NodeOptions>();
  cli::Command command = app.add_command(
      "network",
      "Print what another program needs to meet a scene's nodes: Cyclone DDS's configuration, for CYCLONEDDS_URI");
  command.add_option("SCENE", o->scene, "Scene file").required();
  command.add_option("--domain", o->domain, "DDS domain in place of the scene's").between(0, 230);
  command.add_option("--interface", o->interface, "Network interface in place of the scene's");
  command.add_option("--peer", o->peers, "Host to look for nodes on, in place of the scene's; may be repeated");
  command.examples({"palpate network scenes/liver.toml",
                    "palpate network scenes/two_hosts.toml --interface eth0 --peer HOST > network.xml"});
  command.does([o] { print_network(*o); });
}

}  // namespace palpate
