#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "common/log/log.hpp"
#include "common/node/node_setup.hpp"
#include "common/node/range_summary.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/scene/moved_files.hpp"
#include "common/view/view_origin.hpp"
#include "render_node/render_loop.hpp"
#include "render_node/scene_stage.hpp"

namespace palpate {
namespace {

struct RenderOptions {
  bool deform = false;
  std::string film, still;
  double film_rate = 30;
  int samples = 1;
  int threads = 0;
};
RenderOptions options;

std::unique_ptr<SurfaceSource> make_source(Bus& bus, const Presence& presence, const LoadedScene& loaded) {
  const Eigen::Vector3d origin = view_origin(loaded.archives);
  if (options.deform)
    return deform_surfaces(loaded.scene, bus, presence, Deformer(loaded.scene, loaded.archives), origin);
  std::vector<std::size_t> nodes;
  for (const Archive& archive : loaded.archives) nodes.push_back(archive.surface.position.size());
  return receive_surfaces(bus, presence, std::move(nodes), origin);
}

void summarise(const RenderReport& r, const Film* film, const RangeMonitor* range, bool supervised) {
  const auto us = [](const Histogram& h, double share) { return 1e-3 * static_cast<double>(h.percentile(share)); };
  nlohmann::json summary{{"node", "render"},
                         {"seconds", r.seconds},
                         {"frames", r.frames},
                         {"missed", r.missed},
                         {"behind_s", r.behind},
                         {"refused", r.refused},
                         {"rate_hz", r.seconds > 0 ? static_cast<double>(r.frames) / r.seconds : 0.0},
                         {"latency_us_p50", us(r.latency, 0.5)},
                         {"latency_us_p99", us(r.latency, 0.99)},
                         {"draw_us_p50", us(r.draw, 0.5)},
                         {"draw_us_p99", us(r.draw, 0.99)},
                         {"force_max_n", r.peak_force}};
  if (film)
    summary.update({{"film_frames", film->frames()},
                    {"film_repeated", r.film.repeated},
                    {"film_skipped", r.film.skipped},
                    {"film_longest_stand_s", r.film.longest_stand}});
  if (range) summary["range"] = range_summary(*range);
  if (supervised) fmt::print("{}\n", summary.dump());
  log_info(fmt::format("{} frames, {:.1f} Hz, drawn in p50 {:.1f} ms, tool to picture p50 {:.1f} ms, p99 {:.1f} ms",
                       r.frames, summary["rate_hz"].get<double>(), 1e-3 * us(r.draw, 0.5), 1e-3 * us(r.latency, 0.5),
                       1e-3 * us(r.latency, 0.99)));
}

void run(const NodeOptions& o) {
  if (options.threads > 0) ::setenv("LP_NUM_THREADS", fmt::format("{}", options.threads).c_str(), 1);
  LoadedScene loaded = load_for_node(o, options.deform ? ArchivePart::surface : ArchivePart::header);
  keep_files_of(loaded.scene, {options.film, options.still});
  const bool moves = has_moving_tissue(loaded.scene);
  if (options.deform && moves)
    throw std::runtime_error(o.scene + ": moving tissue belongs to a deform node; leave --deform out");
  Stage stage = make_stage(loaded);
  const Render picture = loaded.scene.render.value_or(Render{});
  Renderer renderer(picture.width, picture.height, options.samples);

  const std::unique_ptr<Bus> bus = make_dds_bus(bus_settings(loaded.scene, o, "render"));
  Presence presence(*bus, "render", 0, loaded.scene_hash, loaded.archive_hash);
  const std::unique_ptr<SurfaceSource> source = make_source(*bus, presence, loaded);
  std::optional<TopologyFeed> topology;
  if (moves) topology.emplace(*bus, presence, loaded.archives);
  loaded.archives.clear();
  catch_shutdown_signals();
  std::optional<Film> film;  // from here on the file is not left half written
  if (!options.film.empty()) film.emplace(options.film, picture.width, picture.height, options.film_rate);
  RenderLoop loop(loaded.scene, std::move(stage), *source, *bus, presence, renderer);
  if (topology) loop.set_topology(&*topology);
  if (film) loop.set_film(&*film);
  say_ready(o);
  const RenderReport& report = loop.run(o.seconds);
  if (film) film->finish();
  if (!options.still.empty()) write_still(loop.best_moment(), picture.width, picture.height, options.still);
  summarise(report, film ? &*film : nullptr, source->range(), o.supervised);
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::NodeOptions node;
  palpate::RenderOptions& o = palpate::options;
  palpate::cli::CommandLine app{"render_node: draws the organs and the instruments, off screen"};
  palpate::add_node_options(app, node);
  app.add_flag("--deform", o.deform, "Superpose the contacts in this process; no deform node is needed");
  app.add_option("--film", o.film, "Write a film (MP4) in real time").output_file(".mp4");
  app.add_option("--film-rate", o.film_rate, "Frames per second of the film").between(1.0, 120.0).show_default();
  app.add_option("--still", o.still, "Write a picture (PNG) of the moment of the greatest force, at the end")
      .output_file(".png");
  app.add_option("--samples", o.samples, "Samples per pixel of the film: 4 smooths edges and takes twice the time")
      .one_of({1, 4})
      .show_default();
  app.add_option("--threads", o.threads, "Threads that draw; default: one per core").between(1, 64);
  app.examples({"render_node scenes/liver.toml --deform --film out/liver.mp4",
                "render_node scenes/two_hosts.toml --interface eth0 --peer HOST --still out/moment.png"});
  return palpate::node_main("render_node", argc, argv, app, palpate::run, node);
}
