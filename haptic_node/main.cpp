#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/bus/domain_claim.hpp"
#include "common/kernels/code_path.hpp"
#include "common/log/log.hpp"
#include "common/node/handling_summary.hpp"
#include "common/node/node_setup.hpp"
#include "common/realtime/shutdown.hpp"
#include "haptic_node/haptic_loop.hpp"
#include "haptic_node/start.hpp"
#include "haptic_node/summary.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;

/// `hands`: people may take tools that follow a file.
void run(const NodeOptions& o, bool hands) {
  LoadedScene loaded = load_for_node(o, ArchivePart::touchable, ArchivePart::header);
  const Scene& scene = loaded.scene;
  if (scene.tools.size() > StepRecord::kMaxTools)
    throw std::runtime_error(fmt::format("{}: {} tools; at most {} run in one haptic node", o.scene, scene.tools.size(),
                                         StepRecord::kMaxTools));
  HapticStep haptic(scene, loaded.archives);
  std::vector<std::unique_ptr<Device>> devices = make_devices(scene.tools, scene.rates.haptic_hz, hands);

  const std::uint64_t run_id = new_run();
  const BusSettings settings = bus_settings(scene, o, "haptic");
  const DomainClaim domain = DomainClaim::of_haptic_node(settings.domain);
  const std::unique_ptr<Bus> bus = make_dds_bus(settings);
  Presence presence(*bus, "haptic", run_id, loaded.scene_hash, loaded.archive_hash);
  std::optional<TopologyMemory> topology;
  if (haptic.has_moving_tissue()) topology.emplace(*bus, presence, loaded.archives);
  loaded.archives.clear();
  const auto scene_writer = bus->writer(topics::scene);
  scene_writer->write(
      {.run = run_id, .seq = 1, .scene_hash = loaded.scene_hash, .text = to_toml(scene), .code_path = code_path()});
  catch_shutdown_signals();
  say_ready(o);
  wait_for_devices(devices, *bus, o.seconds);
  if (shutdown_requested()) return;
  const std::uint64_t refused_contacts = start_tools(haptic, devices, *bus, presence);
  // Peers need a moment to match; what is sent before is lost to them.
  const auto matched = std::chrono::steady_clock::now() + 500ms;
  while (std::chrono::steady_clock::now() < matched && !shutdown_requested()) {
    for (const std::string& said : presence.watch()) log_info(said);
    bus->wait(20ms);
  }
  presence.claim("the tools", Presence::Of::domain);
  log_info(fmt::format("haptic loop at {:.0f} Hz, code path {}", scene.rates.haptic_hz, code_path()));
  for (const HapticStep::Entry& entry : haptic.entries())
    if (const std::string said = entry.part->introduction(); !said.empty())
      log_info(fmt::format("body '{}': {}", entry.name, said));
  HapticLoop loop(haptic, devices, *bus, presence, run_id, code_path());
  if (topology) loop.set_topology(&*topology);
  const LoopReport& report = loop.run(o.seconds);
  nlohmann::json summary = summary_of(report);
  summary["refused_contacts"] = refused_contacts;
  if (const nlohmann::json tasks = tasks_of(haptic, scene); !tasks.empty()) summary["tasks"] = tasks;
  for (std::size_t t = 0; t < scene.tools.size(); ++t)
    summary["tools"].push_back(handling_summary(scene.tools[t].name, loop.handling(static_cast<int>(t))));
  if (o.supervised) fmt::print("{}\n", summary.dump());
  say(report);
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::NodeOptions options;
  bool hands = false;
  palpate::cli::CommandLine app{"haptic_node: collision and force at the device's rate, from precomputed tensors"};
  palpate::add_node_options(app, options);
  app.add_flag("--hands", hands, "People may take tools that follow a file; web_node needs the same");
  app.examples(
      {"haptic_node scenes/liver.toml --seconds 10", "haptic_node scenes/two_hosts.toml --interface eth0 --peer HOST"});
  return palpate::node_main(
      "haptic_node", argc, argv, app, [&](const auto& o) { palpate::run(o, hands); }, options);
}
