#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/kernels/code_path.hpp"
#include "common/log/log.hpp"
#include "common/node/handling_summary.hpp"
#include "common/node/node_setup.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/sim/step_messages.hpp"
#include "haptic_node/haptic_loop.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;

bool hands = false;  // people may take tools that follow a file

/// Waits until every driver elsewhere has spoken, saying once that it waits. Throws std::runtime_error if one has not
/// after `seconds`; 0: there is no limit.
void wait_for_devices(std::vector<std::unique_ptr<Device>>& devices, Bus& bus, double seconds) {
  BusDevices drivers(bus, devices);
  const auto all_ready = [&] {
    return std::all_of(devices.begin(), devices.end(), [](const auto& d) { return d->ready(); });
  };
  if (!all_ready()) log_info(fmt::format("waiting for a driver on topic {}", topics::device_state.name));
  const auto begin = std::chrono::steady_clock::now();
  while (!all_ready() && !shutdown_requested()) {
    if (seconds > 0 && std::chrono::steady_clock::now() - begin > std::chrono::duration<double>(seconds))
      throw std::runtime_error(
          fmt::format("no driver on topic {} has spoken for {} s", topics::device_state.name, seconds));
    std::this_thread::sleep_for(250us);
    drivers.take();
  }
}

/// Takes up the last contacts of a haptic node that died, where peers with the same scene keep them, until no tool is
/// within a body without them, for a second at most. Returns how many messages were refused.
std::uint64_t resume(HapticStep& haptic, Bus& bus, Presence& presence) {
  const auto reader = bus.reader(topics::held_contacts, Keep::all);  // false ones do not take the place of true ones
  std::uint64_t refused = 0;
  const auto limit = std::chrono::steady_clock::now() + 1s;
  const auto over = [&] { return haptic.starts_inside().empty() || std::chrono::steady_clock::now() > limit; };
  while (!over()) {
    bus.wait(20ms);
    for (const std::string& said : presence.watch()) log_info(said);
    // What comes before its sender is known waits in the reader.
    const bool known = presence.matched("deform") || presence.matched("render");
    while (const auto kept = known && !over() ? reader->take() : std::nullopt)
      if (!haptic.resume(*kept) && ++refused == 1)
        log_warning("a peer keeps contacts that cannot be of this scene and these tools; they are left");
  }
  return refused;
}

/// Returns how many messages with contacts that peers kept were refused.
std::uint64_t start(HapticStep& haptic, std::vector<std::unique_ptr<Device>>& devices, Bus& bus, Presence& presence) {
  std::vector<ToolDofs> dofs;
  for (auto& device : devices) dofs.push_back(device->read(0).dofs);
  haptic.place(dofs);
  if (haptic.starts_inside().empty()) return 0;
  const std::uint64_t refused = resume(haptic, bus, presence);
  if (const std::string inside = haptic.starts_inside(); !inside.empty()) throw std::runtime_error(inside);
  log_info("took up the contacts that peers kept");
  return refused;
}

/// How the tasks of a scene ended, one entry a body that has one.
nlohmann::json tasks_of(const HapticStep& haptic, const Scene& scene) {
  nlohmann::json tasks = nlohmann::json::array();
  for (const TaskRecord& task : task_records(haptic)) {
    const std::string& body = name_of(scene.bodies[task.body]);
    tasks.push_back(task_summary(body, task));
    log_info(fmt::format(
        "task of '{}': {:.1f} mm inserted ({:.1f} mm at the deepest, {:.1f} s after it went in), largest force {:.2f} "
        "N, {} wall contacts, "
        "{} grasps, {} drops, held for {:.1f} s",
        body, 1e3 * task.inserted, 1e3 * task.deepest, task.inserting_s, task.max_force, task.wall_contacts,
        task.grasps, task.drops, task.held_s));
  }
  return tasks;
}

nlohmann::json summary_of(const LoopReport& r) {
  const auto us = [](const Histogram& h, double share) { return 1e-3 * static_cast<double>(h.percentile(share)); };
  return {{"node", "haptic"},
          {"seconds", r.seconds},
          {"rate_hz", r.seconds > 0 ? static_cast<double>(r.ticks) / r.seconds : 0.0},
          {"ticks", r.ticks},
          {"missed", r.period.skipped},
          {"dropped", r.dropped},
          {"step_us_p50", us(r.step, 0.5)},
          {"step_us_p99", us(r.step, 0.99)},
          {"step_us_p999", us(r.step, 0.999)},
          {"step_us_max", us(r.step, 1)},
          {"push_us_p50", us(r.push, 0.5)},
          {"ring_to_wire_us_p50", us(r.wire, 0.5)},
          {"ring_to_wire_us_p99", us(r.wire, 0.99)},
          {"late_us_p50", us(r.period.wake, 0.5)},
          {"late_us_p99", us(r.period.wake, 0.99)},
          {"slack_us_p50", us(r.period.slack, 0.5)},
          {"slack_us_p1", us(r.period.slack, 0.01)},
          {"force_max_n", r.max_force},
          {"limited_steps", r.limited},
          {"force_limited_steps", r.force_limited},
          {"slew_limited_steps", r.slew_limited},
          {"silent_device_steps", r.silent},
          {"behind_s", r.behind},
          {"regularised_steps", r.regularised},
          {"fault_steps", r.faults},
          {"stale_model_steps", r.stale},
          {"late_tissue_steps", r.late},
          {"refused_samples", r.refused_samples},
          {"followed_steps", r.followed_samples},
          {"refused_models", r.refused_models},
          {"implausible_models", r.implausible_models},
          {"implausible_force_steps", r.implausible},
          {"refused_messages", r.refused_messages},
          {"passivity_limited_steps", r.damped},
          {"energy_min_j", r.min_energy}};
}

void run(const NodeOptions& o) {
  LoadedScene loaded = load_for_node(o, ArchivePart::touchable, ArchivePart::header);
  const Scene& scene = loaded.scene;
  if (scene.tools.size() > StepRecord::kMaxTools)
    throw std::runtime_error(fmt::format("{}: {} tools; at most {} run in one haptic node", o.scene, scene.tools.size(),
                                         StepRecord::kMaxTools));
  HapticStep haptic(scene, loaded.archives);
  std::vector<std::unique_ptr<Device>> devices = make_devices(scene.tools, scene.rates.haptic_hz, hands);

  const std::uint64_t run_id = new_run();
  const std::unique_ptr<Bus> bus = make_dds_bus(bus_settings(scene, o, "haptic"));
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
  const std::uint64_t refused_contacts = start(haptic, devices, *bus, presence);
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
      log_info(fmt::format("body '{}': {}", name_of(scene.bodies[entry.body]), said));
  HapticLoop loop(haptic, devices, *bus, presence, run_id, code_path());
  if (topology) loop.set_topology(&*topology);
  const LoopReport& report = loop.run(o.seconds);
  nlohmann::json summary = summary_of(report);
  summary["refused_contacts"] = refused_contacts;
  if (const nlohmann::json tasks = tasks_of(haptic, scene); !tasks.empty()) summary["tasks"] = tasks;
  for (std::size_t t = 0; t < scene.tools.size(); ++t)
    summary["tools"].push_back(handling_summary(scene.tools[t].name, loop.handling(static_cast<int>(t))));
  if (report.damped > 0)
    log_info(
        fmt::format("{} steps were damped, as the tools took out more energy than they had put in: {:.1f} mJ at most",
                    report.damped, -1e3 * report.min_energy));
  if (o.supervised) fmt::print("{}\n", summary.dump());
  log_info(fmt::format(
      "{:.1f} Hz over {:.1f} s, step p50 {:.1f} us, p99.9 {:.1f} us, missed {} ticks, largest force {:.2f} N",
      summary["rate_hz"].get<double>(), report.seconds, summary["step_us_p50"].get<double>(),
      summary["step_us_p999"].get<double>(), report.period.skipped, report.max_force));
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::NodeOptions options;
  palpate::cli::CommandLine app{"haptic_node: collision and force at the device's rate, from precomputed tensors"};
  palpate::add_node_options(app, options);
  app.add_flag("--hands", palpate::hands, "People may take tools that follow a file; web_node needs the same");
  app.examples(
      {"haptic_node scenes/liver.toml --seconds 10", "haptic_node scenes/two_hosts.toml --interface eth0 --peer HOST"});
  return palpate::node_main("haptic_node", argc, argv, app, palpate::run, options);
}
