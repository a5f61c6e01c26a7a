#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <nlohmann/json.hpp>

#include "common/node/node_setup.hpp"
#include "common/realtime/shutdown.hpp"
#include "deform_node/deform_loop.hpp"

namespace palpate {
namespace {

void run(const NodeOptions& o) {
  LoadedScene loaded = load_for_node(o, ArchivePart::surface);
  Deformer deformer(loaded.scene, loaded.archives);
  loaded.archives.clear();
  const std::unique_ptr<Bus> bus = make_dds_bus(bus_settings(loaded.scene, o));
  Presence presence(*bus, "deform", 0, loaded.scene_hash, loaded.archive_hash);
  catch_shutdown_signals();
  DeformLoop loop(deformer, *bus, presence, loaded.scene.rates.visual_hz);
  say_ready(o);
  const DeformReport& r = loop.run(o.seconds);
  const nlohmann::json summary{{"node", "deform"},
                               {"seconds", r.seconds},
                               {"frames", r.frames},
                               {"rate_hz", r.seconds > 0 ? static_cast<double>(r.frames) / r.seconds : 0.0},
                               {"latency_us_p50", 1e-3 * static_cast<double>(r.latency.percentile(0.5))},
                               {"latency_us_p99", 1e-3 * static_cast<double>(r.latency.percentile(0.99))},
                               {"deform_us_p50", 1e-3 * static_cast<double>(r.deform.percentile(0.5))},
                               {"refused", r.refused}};
  if (o.supervised) fmt::print("{}\n", summary.dump());
  spdlog::info("{} frames, {:.1f} Hz, sense to surface p50 {:.0f} us, p99 {:.0f} us", r.frames, summary["rate_hz"].get<double>(),
               summary["latency_us_p50"].get<double>(), summary["latency_us_p99"].get<double>());
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::NodeOptions options;
  CLI::App app{"deform_node: rebuilds the organs' shape from contact information and publishes the surface"};
  palpate::add_node_options(app, options);
  return palpate::node_main("deform_node", argc, argv, app, palpate::run, options);
}
