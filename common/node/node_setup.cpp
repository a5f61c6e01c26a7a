#include "common/node/node_setup.hpp"

#include <chrono>
#include <cstdio>
#include <random>

#include "common/cli/progress.hpp"
#include "common/describe/printable.hpp"
#include "common/log/log.hpp"
#include "common/realtime/settings.hpp"
#include "common/scene/find_archive.hpp"
#include "common/scene/scene_changes.hpp"

namespace palpate {

void add_node_options(cli::CommandLine& app, NodeOptions& o) {
  app.show_version(PALPATE_VERSION);
  app.add_option("SCENE", o.scene, "Scene file").required();
  app.add_option("--set", o.set,
                 "KEY=VALUE in place of what the scene file says, alike for all its nodes; may be repeated")
      .one_value_each_time();
  app.add_option("--seconds", o.seconds, "Stop after so many seconds, or where no driver has spoken for so long")
      .positive();
  app.add_option("--domain", o.domain, "DDS domain in place of the scene's").between(0, 230);
  app.add_option("--interface", o.interface, "Network interface in place of the scene's");
  app.add_option("--peer", o.peers, "Host to look for peers on, in place of the scene's; may be repeated");
  app.add_option("--keys", o.keys, "Folder of keys in place of the scene's");
  app.may_be_quiet();
  app.add_flag("--supervised", o.supervised, "For `palpate run`: print 'ready' and a JSON summary on standard output");
}

BusSettings bus_settings(const Scene& scene, const NodeOptions& o, const std::string& role) {
  BusSettings settings;
  settings.domain = o.domain >= 0 ? o.domain : scene.network.domain;
  settings.interface = o.interface.empty() ? scene.network.interface : o.interface;
  settings.peers = o.peers.empty() ? scene.network.peers : o.peers;
  if (scene.network.security) settings.keys = scene.network.security->keys;
  if (!o.keys.empty()) settings.keys = o.keys;
  settings.role = role;
  settings.favoured = role == "haptic" || role == "deform";  // pictures yield to forces
  settings.newest_alone = role == "render" || role == "web";
  settings.gathers = role == "haptic";  // it tells of all tools at once, a thousand times a second
  return settings;
}

LoadedScene with_archives(Scene scene, ArchivePart part, ArchivePart of_dynamic) {
  LoadedScene loaded{.scene = std::move(scene)};
  loaded.scene_hash = scene_hash(loaded.scene);
  for (const Body& body : loaded.scene.bodies) {
    const ArchivePart needed = owner_of(body) == Owner::deform_node ? of_dynamic : part;
    loaded.archives.push_back(find_archive(loaded.scene, body, needed));
    loaded.archive_hash += loaded.archives.back().content_hash;
  }
  return loaded;
}

LoadedScene load_for_node(const NodeOptions& options, ArchivePart part, ArchivePart of_dynamic) {
  return with_archives(load_scene(options.scene, parse_changes(options.set)), part, of_dynamic);
}

std::uint64_t new_run() {
  constexpr int kRandomBits = 22;
  const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
  const auto ms =
      static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::milliseconds>(since_epoch).count());
  return ms << kRandomBits | std::random_device()() >> (32 - kRandomBits);
}

void say_ready(const NodeOptions& options) {
  if (!options.supervised) return;
  std::puts("ready");
  std::fflush(stdout);
}

int node_main(const char* name, int argc, char** argv, cli::CommandLine& app,
              const std::function<void(const NodeOptions&)>& body, const NodeOptions& options) {
  if (const auto status = app.read(argc, argv)) return *status;
  use_small_stacks();
  open_log(name);
  if (cli::telling() == cli::Telling::nothing) log_warnings_alone();
  try {
    body(options);
  } catch (const std::exception& error) {
    std::fflush(stdout);
    std::fprintf(stderr, "%s: %s\n", name, printable(error.what()).c_str());
    return 1;
  }
  std::fflush(stdout);
  return 0;
}

}  // namespace palpate
