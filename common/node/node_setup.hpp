#pragma once
#include <functional>
#include <string>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/bus/dds_bus.hpp"
#include "common/cli/command_line.hpp"
#include "common/scene/scene.hpp"

/// What every node does before its loop: arguments, scene, archives, logging.
namespace palpate {

struct NodeOptions {
  std::string scene, interface, keys;
  std::vector<std::string> peers, set;  ///< set: for parse_changes()
  double seconds = 0;                   ///< 0: no limit
  int domain = -1;                      ///< -1: the scene's
  bool supervised = false;              ///< started by `palpate run`: says "ready" and prints one JSON line at the end
};

void add_node_options(cli::CommandLine& app, NodeOptions& options);

/// The scene's network section with what the command line replaces. `role`: of roles.hpp, for the keys.
BusSettings bus_settings(const Scene& scene, const NodeOptions& options, const std::string& role);

/// A scene with the archives of its bodies, and the hashes by which nodes know each other.
struct LoadedScene {
  Scene scene;
  std::vector<Archive> archives;  ///< one per body
  std::string scene_hash, archive_hash;
};
/// `part` of each body's archive, `of_dynamic` of those whose model is dynamic.
LoadedScene with_archives(Scene scene, ArchivePart part, ArchivePart of_dynamic);
/// The same of the scene that a command line names.
LoadedScene load_for_node(const NodeOptions& options, ArchivePart part, ArchivePart of_dynamic);
inline LoadedScene load_for_node(const NodeOptions& options, ArchivePart part) {
  return load_for_node(options, part, part);
}

/// A number, not 0, that identifies one start of a loop: of the time in milliseconds, so that an earlier one is
/// smaller, and random below that.
std::uint64_t new_run();

/// Tells `palpate run` that this node listens.
void say_ready(const NodeOptions& options);

/// Runs `body` with logging under the node's name; prints the sentence of an exception and returns the exit status.
int node_main(const char* name, int argc, char** argv, cli::CommandLine& app,
              const std::function<void(const NodeOptions&)>& body, const NodeOptions& options);

}  // namespace palpate
