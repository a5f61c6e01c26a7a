#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/fem/processor_blas.hpp"
#include "common/kernels/code_path.hpp"
#include "common/log/log.hpp"
#include "common/node/handling_summary.hpp"
#include "common/node/node_setup.hpp"
#include "common/node/range_summary.hpp"
#include "common/realtime/shutdown.hpp"
#include "deform_node/deform_loop.hpp"
#include "deform_node/dynamic_loop.hpp"

namespace palpate {
namespace {

bool whole = false;  // begin with whole bodies

double us(const Histogram& h, double share) {
  return 1e-3 * static_cast<double>(h.percentile(share));
}

double rate(std::uint64_t count, double seconds) {
  return seconds > 0 ? static_cast<double>(count) / seconds : 0.0;
}

nlohmann::json superpose(const NodeOptions& o, const LoadedScene& loaded, Deformer& deformer) {
  const std::unique_ptr<Bus> bus = make_dds_bus(bus_settings(loaded.scene, o, "deform"));
  Presence presence(*bus, "deform", 0, loaded.scene_hash, loaded.archive_hash);
  catch_shutdown_signals();
  DeformLoop loop(loaded.scene, deformer, *bus, presence);
  say_ready(o);
  const DeformReport& r = loop.run(o.seconds);
  log_info(fmt::format("{} frames, {:.1f} Hz, sense to surface p50 {:.0f} us, p99 {:.0f} us", r.frames,
                       rate(r.frames, r.seconds), us(r.latency, 0.5), us(r.latency, 0.99)));
  return {{"node", "deform"},
          {"seconds", r.seconds},
          {"frames", r.frames},
          {"rate_hz", rate(r.frames, r.seconds)},
          {"latency_us_p50", us(r.latency, 0.5)},
          {"latency_us_p99", us(r.latency, 0.99)},
          {"deform_us_p50", us(r.deform, 0.5)},
          {"range", range_summary(loop.range())},
          {"refused", r.refused}};
}

nlohmann::json advance(const NodeOptions& o, const LoadedScene& loaded, Deformer& deformer) {
  DynamicWorld world(loaded.scene, loaded.archives);
  LocalModels local_models(world, loaded.archives);
  const std::uint64_t run = new_run();
  const std::unique_ptr<Bus> bus = make_dds_bus(bus_settings(loaded.scene, o, "deform"));
  Presence presence(*bus, "deform", run, loaded.scene_hash, loaded.archive_hash);
  catch_shutdown_signals();
  for (int i = 0; i < world.organs(); ++i)
    log_info(fmt::format("body '{}': {} tetrahedra move in {} steps a tick, at most {:.3g} s each",
                         name_of(loaded.scene.bodies[world.bodies()[i]]), world.organ(i).topology().alive_count(),
                         world.organ(i).steps_in(world.dt()), world.organ(i).max_step()));
  DynamicLoop loop(world, local_models, deformer, *bus, presence, loaded.scene, run, code_path());
  if (whole) loop.forget_earlier_cuts();
  say_ready(o);
  const DynamicReport& r = loop.run(o.seconds);
  log_info(
      fmt::format("{:.1f} Hz over {:.1f} s, tick p50 {:.0f} us, p99 {:.0f} us, missed {} ticks, the tissue's time "
                  "{:.3f} s late; {} tetrahedra cut, {} torn, {} fallen away",
                  rate(r.ticks, r.seconds), r.seconds, us(r.tick, 0.5), us(r.tick, 0.99), r.period.skipped,
                  1e-9 * static_cast<double>(r.late_ns), r.cut, r.torn, r.fallen));
  nlohmann::json resections = nlohmann::json::array();
  for (const auto& [body, resection] : loop.resections())
    resections.push_back(resection_summary(name_of(loaded.scene.bodies[body]), resection));
  return {{"node", "deform"},
          {"seconds", r.seconds},
          {"frames", r.frames},
          {"rate_hz", rate(r.frames, r.seconds)},
          {"ticks", r.ticks},
          {"tick_hz", rate(r.ticks, r.seconds)},
          {"missed", r.period.skipped},
          {"behind_s", r.behind},
          {"late_s", 1e-9 * static_cast<double>(r.late_ns)},
          {"tick_us_p50", us(r.tick, 0.5)},
          {"tick_us_p99", us(r.tick, 0.99)},
          {"tick_us_max", us(r.tick, 1)},
          {"latency_us_p50", us(r.latency, 0.5)},
          {"latency_us_p99", us(r.latency, 0.99)},
          {"tetrahedra_cut", r.cut},
          {"tetrahedra_torn", r.torn},
          {"tetrahedra_fallen", r.fallen},
          {"resections", resections},
          {"range", range_summary(loop.range())},
          {"state_hash", fmt::format("{:016x}", world.hash())},
          {"refused", r.refused}};
}

void run(const NodeOptions& o) {
  LoadedScene loaded = load_for_node(o, ArchivePart::surface);
  Deformer deformer(loaded.scene, loaded.archives);
  const bool moves = has_moving_tissue(loaded.scene);
  if (!moves) loaded.archives.clear();
  const nlohmann::json summary = moves ? advance(o, loaded, deformer) : superpose(o, loaded, deformer);
  if (o.supervised) fmt::print("{}\n", summary.dump());
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::use_one_blas_thread(argv);
  palpate::NodeOptions options;
  palpate::cli::CommandLine app{
      "deform_node: rebuilds the organs' shape from contact information and publishes the surface"};
  palpate::add_node_options(app, options);
  app.add_flag("--whole", palpate::whole, "Begin with whole bodies, even if other nodes know them to have been cut");
  app.examples(
      {"deform_node scenes/hepatectomy.toml", "deform_node scenes/two_hosts.toml --interface eth0 --peer HOST"});
  return palpate::node_main("deform_node", argc, argv, app, palpate::run, options);
}
