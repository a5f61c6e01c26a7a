#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/dynamics/elastic_mesh.hpp"
#include "common/log/log.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/near_origin.hpp"
#include "common/models/marked_to_resect.hpp"
#include "common/node/node_setup.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/view/view_origin.hpp"
#include "web_node/door.hpp"
#include "web_node/web_loop.hpp"

namespace palpate {
namespace {

struct WebOptions {
  std::string address;
  int port = -1;
  bool hands = false;
};
WebOptions options;

web::ServerSettings server_settings(const Scene& scene) {
  web::ServerSettings settings;
  settings.address = options.address.empty() ? scene.web.address : options.address;
  settings.port = options.port < 0 ? scene.web.port : options.port;
  settings.tools = static_cast<int>(scene.tools.size());
  if (!web::is_loopback(settings.address)) settings.secret = web::random_secret();
  return settings;
}

std::string link_to(const web::ServerSettings& settings, int port) {
  return fmt::format("http://{}:{}/{}", web::host_in_link(settings.address), port,
                     settings.secret.empty() ? "" : settings.secret + "/");
}

std::vector<web::OfferedTool> offered_tools(const Scene& scene, const Eigen::Vector3d& origin) {
  std::vector<web::OfferedTool> tools;
  for (const Tool& tool : scene.tools)
    tools.push_back({is_for_hands(tool.device, options.hands), make_trocar(tool.pivot - origin, tool.axis, tool.up)});
  return tools;
}

TriangleMesh backdrop_of(const Scene& scene) {
  if (!scene.render || scene.render->backdrop.empty()) return {};
  return load_triangle_mesh(scene.render->backdrop, scene.render->backdrop_scale);
}

/// What people do at the page reaches the tools by this.
class Pages {
 public:
  Pages(Bus& bus, web::Hands& hands) : hands_(hands), devices_(bus.writer(topics::device_state)) {}

  void said(std::uint32_t page, const web::Said& said) {
    const double now = 1e-9 * static_cast<double>(now_ns());
    switch (said.kind) {
      case web::Said::take:
        return hands_.take(said.tool, page, now);
      case web::Said::release:
        return hands_.release(said.tool, page);
      case web::Said::give:
        return hands_.give(said.tool, page);
      case web::Said::sample:
        return move(page, said, now);
      case web::Said::taken:
      case web::Said::rest:
        break;
    }
  }

 private:
  void move(std::uint32_t page, const web::Said& said, double now) {
    auto state = hands_.move(said.tool, page, said.motion, now);
    if (!state) return;
    state->sense_ns = now_ns();
    devices_->write(*state);
  }

  web::Hands& hands_;
  std::unique_ptr<Writer<DeviceState>> devices_;
};

void summarise(const web::WebReport& r, const web::Server::Seen& seen, bool supervised) {
  const nlohmann::json summary{{"node", "web"},
                               {"seconds", r.seconds},
                               {"frames", r.frames},
                               {"missed", r.missed},
                               {"rate_hz", r.seconds > 0 ? static_cast<double>(r.frames) / r.seconds : 0.0},
                               {"latency_us_p50", 1e-3 * static_cast<double>(r.latency.percentile(0.5))},
                               {"latency_us_p99", 1e-3 * static_cast<double>(r.latency.percentile(0.99))},
                               {"refused_messages", r.samples_refused},
                               {"refused_requests", seen.refused},
                               {"thrown_out", seen.malformed},
                               {"skipped_frames", seen.skipped}};
  if (supervised) fmt::print("{}\n", summary.dump());
  log_info(
      fmt::format("{} frames, {:.1f} Hz; {} requests refused, {} pages thrown out, {} frames left out for slow ones",
                  r.frames, summary["rate_hz"].get<double>(), seen.refused, seen.malformed, seen.skipped));
}

std::map<int, Resection> resections_of(const LoadedScene& loaded) {
  std::map<int, Resection> all;
  for (std::size_t b = 0; b < loaded.archives.size(); ++b)
    if (const Box* marked = marked_to_resect(loaded.scene.bodies[b]))
      all.emplace(static_cast<int>(b), Resection(*marked, elastic_mesh(loaded.archives[b])));
  return all;
}

void run(const NodeOptions& o) {
  LoadedScene loaded = load_for_node(o, ArchivePart::header);
  const Scene& scene = loaded.scene;
  const Eigen::Vector3d origin = view_origin(loaded.archives);  // of all places at the page
  std::vector<SurfaceMap> surfaces;
  for (const Archive& archive : loaded.archives) surfaces.push_back(archive.surface);
  const std::vector<std::optional<VisualBody>> visuals = load_visuals(scene, loaded.archives, origin);
  std::vector<std::size_t> nodes;
  std::vector<web::WebLoop::Beginning> bodies;
  for (const SurfaceMap& surface : surfaces) {
    nodes.push_back(surface.position.size());
    web::WebLoop::Beginning& body = bodies.emplace_back();
    body.triangles = surface.triangles;
    body.visual = visuals[bodies.size() - 1].has_value();
    body.rest = places_from(origin, surface.position);
  }

  const std::unique_ptr<Bus> bus = make_dds_bus(bus_settings(scene, o, "web"));
  Presence presence(*bus, "web", 0, loaded.scene_hash, loaded.archive_hash);
  const std::unique_ptr<SurfaceSource> source = receive_surfaces(*bus, presence, nodes, origin);
  std::optional<TopologyFeed> topology;
  if (has_moving_tissue(scene)) topology.emplace(*bus, presence, loaded.archives);
  web::Hands hands(offered_tools(scene, origin), static_cast<std::uint64_t>(now_ns() / 1'000'000));
  Pages pages(*bus, hands);
  const web::ServerSettings settings = server_settings(scene);
  web::Server server(settings, {.said = [&](std::uint32_t page, const web::Said& said) { pages.said(page, said); },
                                .gone = [&](std::uint32_t page) { hands.gone(page); }});
  server.publish(web::scenery, {false, web::scenery_message(scene, surfaces, backdrop_of(scene), visuals, origin)});
  std::map<int, Resection> resections = resections_of(loaded);
  loaded.archives.clear();
  catch_shutdown_signals();
  web::WebLoop loop(scene, origin, std::move(bodies), *source, *bus, presence, hands, server);
  if (topology) loop.set_topology(&*topology, std::move(resections));
  fmt::print("live view: {}\n", link_to(settings, server.port()));
  say_ready(o);
  std::fflush(stdout);
  const web::WebReport& report = loop.run(o.seconds);
  summarise(report, server.seen(), o.supervised);
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::NodeOptions node;
  palpate::WebOptions& o = palpate::options;
  palpate::cli::CommandLine app{"web_node: shows a running scene in browsers, and moves its tools for their users"};
  palpate::add_node_options(app, node);
  app.add_option("--address", o.address, "Address to listen at in place of the scene's; default: this host alone");
  app.add_option("--port", o.port, "Port in place of the scene's; 0: any that is free").between(0, 65535);
  app.add_flag("--hands", o.hands, "People may take tools that follow a file; haptic_node needs the same");
  app.examples({"web_node scenes/liver.toml --hands", "web_node scenes/liver.toml --address 0.0.0.0 --port 8081"});
  return palpate::node_main("web_node", argc, argv, app, palpate::run, node);
}
