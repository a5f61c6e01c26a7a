#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/log/log.hpp"
#include "common/node/node_setup.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/view/view_origin.hpp"
#include "ros_bridge/bridge_loop.hpp"
#include "ros_bridge/commands.hpp"

namespace palpate {
namespace {

struct RosOptions {
  int domain = -1;  ///< -1: the scene's
  double rate_hz = 250;
};
RosOptions options;

/// ROS's domain on the scene's network; this side has no keys.
BusSettings ros_settings(const BusSettings& scene) {
  BusSettings ros = scene;
  ros.keys.clear();
  ros.role.clear();
  if (options.domain >= 0) ros.domain = options.domain;
  if (!scene.keys.empty() && ros.domain == scene.domain)
    throw std::runtime_error(
        fmt::format("domain {} is the scene's, and asks for keys: ROS needs another, --ros-domain", ros.domain));
  return ros;
}

/// Two names of the scene may be one as ROS allows them.
void check_names(const Scene& scene) {
  std::map<std::string, std::string> seen;
  const auto check = [&](const std::string& kind, const std::string& name) {
    const auto [at, fresh] = seen.emplace(kind + " " + ros::allowed_name(name), name);
    if (!fresh) throw std::runtime_error(fmt::format("'{}' and '{}' are one name in ROS", at->second, name));
  };
  for (const Tool& tool : scene.tools) check("tool", tool.name);
  for (const Body& body : scene.bodies) check("body", name_of(body));
}

void summarise(const ros::BridgeReport& r, const ros::Commands& commands, bool supervised) {
  const nlohmann::json summary{{"node", "ros"},
                               {"seconds", r.seconds},
                               {"ticks", r.ticks},
                               {"missed", r.missed},
                               {"samples", r.samples},
                               {"commands", commands.taken()},
                               {"refused_commands", commands.refused()},
                               {"refused_messages", r.refused},
                               {"latency_us_p50", 1e-3 * static_cast<double>(r.latency.percentile(0.5))},
                               {"latency_us_p99", 1e-3 * static_cast<double>(r.latency.percentile(0.99))}};
  if (supervised) fmt::print("{}\n", summary.dump());
  log_info(fmt::format("{} states of tools told, {} commands taken, {} refused", r.samples, commands.taken(),
                       commands.refused()));
}

void run(const NodeOptions& o) {
  LoadedScene loaded = load_for_node(o, ArchivePart::header);
  const Scene& scene = loaded.scene;
  check_names(scene);
  std::vector<SurfaceMap> surfaces;
  std::vector<std::size_t> nodes;
  for (const Archive& archive : loaded.archives) {
    surfaces.push_back(archive.surface);
    nodes.push_back(archive.surface.position.size());
  }
  const Eigen::Vector3d origin = view_origin(loaded.archives);
  // Towards the scene it has the rights of the live view: it reads what is shown and moves tools.
  const BusSettings settings = bus_settings(scene, o, "web"), ros_side = ros_settings(settings);
  const std::unique_ptr<Bus> bus = make_dds_bus(settings);
  Presence presence(*bus, "ros", 0, loaded.scene_hash, loaded.archive_hash);
  const std::unique_ptr<SurfaceSource> source = receive_surfaces(*bus, presence, nodes, origin);
  std::optional<TopologyFeed> topology;
  if (has_moving_tissue(scene)) topology.emplace(*bus, presence, loaded.archives);
  loaded.archives.clear();
  ros::Node node(ros_side, "palpate");
  ros::BridgeLoop loop(scene, std::move(surfaces), origin, node, *source, *bus, presence);
  if (topology) loop.set_topology(&*topology);
  ros::Commands commands(node, *bus, scene);
  node.announce();
  log_info(fmt::format("ROS: {}", dds_place(ros_side)));
  catch_shutdown_signals();
  say_ready(o);
  commands.begin();
  const ros::BridgeReport& report = loop.run(options.rate_hz, o.seconds);
  commands.end();
  summarise(report, commands, o.supervised);
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::NodeOptions node;
  palpate::RosOptions& o = palpate::options;
  palpate::cli::CommandLine app{
      "ros_bridge: shows a running scene to ROS 2 as standard messages, and moves its tools by commands from there"};
  palpate::add_node_options(app, node);
  app.add_option("--ros-domain", o.domain, "Domain of ROS (ROS_DOMAIN_ID); default: the scene's").between(0, 230);
  app.add_option("--rate", o.rate_hz, "Poses, joints and wrenches a second [Hz]").between(1.0, 1000.0).show_default();
  app.examples({"ros_bridge scenes/liver.toml", "ros_bridge scenes/hepatectomy.toml --ros-domain 42 --rate 100"});
  return palpate::node_main("ros_bridge", argc, argv, app, palpate::run, node);
}
