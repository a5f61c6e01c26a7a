#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "common/bus/domain_claim.hpp"
#include "common/cli/progress.hpp"
#include "common/devices/device.hpp"
#include "common/files/atomic_file.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/moved_files.hpp"
#include "common/scene/scene_changes.hpp"
#include "common/tool/trajectory.hpp"
#include "tools/guard_summary.hpp"
#include "tools/node_plan.hpp"
#include "tools/run_nodes.hpp"
#include "tools/run_summary.hpp"
#include "tools/shared/child_process.hpp"
#include "tools/shared/commands.hpp"
#include "tools/shared/say_stages.hpp"
#include "tools/shared/set_option.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr double kShortRun = 600;               // [s]: its log keeps everything
const std::string kScenesPort = "the scene's";  // for --web without a port

struct RunOptions {
  std::string scene, record, keep, film, still, summary, keys, domain, web;
  std::vector<std::string> set;
  double seconds = 0;
  int processes = 0;  ///< 0: those that somebody looks at
  bool strict = false;
  bool json = false;
  bool force = false;  ///< outputs may replace files of another kind
};

/// [s] after which the run ends by itself; 0: who knows.
double end_of(const Scene& scene, const RunOptions& o) {
  if (o.seconds > 0) return o.seconds;
  if (!o.web.empty()) return 0;
  double longest = 0;
  for (const Tool& tool : scene.tools) {
    const std::optional<Trajectory> script = script_of(tool.device);
    if (!script) return 0;
    longest = std::max(longest, script->duration());
  }
  return longest;
}

/// Empty: none is written.
std::string log_of(const Scene& scene, const RunOptions& o) {
  return !o.record.empty() ? o.record : scene.record ? scene.record->file.string() : "";
}

/// The recorder knows no scene, so the scene's network is passed on.
std::vector<std::string> recorder_command(const Scene& scene, const std::string& log, const RunOptions& o) {
  const double end = o.keep.empty() ? end_of(scene, o) : 0;
  const std::string kept = end > 0 && end <= kShortRun ? "everything" : "enough";
  std::vector<std::string> command{sibling_program("palpate"), "record", "--output=" + log, "--keep",
                                   o.keep.empty() ? kept : o.keep};
  if (o.force) command.push_back("--force");
  if (!scene.network.interface.empty()) command.insert(command.end(), {"--interface", scene.network.interface});
  for (const std::string& peer : scene.network.peers) command.insert(command.end(), {"--peer", peer});
  if (o.keys.empty() && scene.network.security) command.insert(command.end(), {"--keys", scene.network.security->keys});
  return command;
}

// The scene's domain or the first free one after it, unless one is asked for.
DomainClaim claim_domain(const Scene& scene, const RunOptions& o) {
  if (!o.domain.empty() && o.domain != "auto") return DomainClaim(parse_domain(o.domain));
  DomainClaim claim = DomainClaim::first_free(scene.network.domain);
  if (claim.domain() != scene.network.domain)
    fmt::print(stderr, "domain {} is another's on this host; this one takes domain {}\n", scene.network.domain,
               claim.domain());
  return claim;
}

std::vector<std::string> web_command(const RunOptions& o) {
  std::vector<std::string> command{sibling_program("web_node"), o.scene, "--hands"};
  if (o.web != kScenesPort) command.insert(command.end(), {"--port", o.web});
  return command;
}

NodePlan plan_of(const Scene& scene, const RunOptions& o) {
  return plan_nodes(scene, {.log = !o.record.empty(),
                            .picture = !o.film.empty() || !o.still.empty(),
                            .browsers = !o.web.empty(),
                            .processes = o.processes});
}

/// False where it is stopped before all of them run.
bool start_nodes(RunNodes& nodes, const Scene& scene, int domain_id, const RunOptions& o) {
  const std::string domain = std::to_string(domain_id);
  const auto with = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--domain", domain, "--supervised"});
    if (!o.keys.empty()) arguments.insert(arguments.end(), {"--keys", o.keys});
    return arguments;
  };
  const auto node = [&](std::vector<std::string> arguments) {
    if (cli::telling() == cli::Telling::nothing) arguments.push_back("--quiet");
    for (const std::string& change : o.set) arguments.insert(arguments.end(), {"--set", change});
    return with(std::move(arguments));
  };
  const NodePlan plan = plan_of(scene, o);
  if (plan.recorder) nodes.start(kRecorder, with(recorder_command(scene, log_of(scene, o), o)));
  if (plan.deform) nodes.start("deform_node", node({sibling_program("deform_node"), o.scene}));
  if (plan.render) {
    std::vector<std::string> render = node({sibling_program("render_node"), o.scene});
    if (plan.superposes()) render.push_back("--deform");
    if (!o.film.empty()) render.push_back("--film=" + o.film);
    if (!o.still.empty()) render.push_back("--still=" + o.still);
    if (o.force) render.push_back("--force");
    nodes.start("render_node", render);
  }
  if (plan.web) nodes.start("web_node", node(web_command(o)));
  nodes.wait_ready();
  if (shutdown_requested()) return false;
  std::vector<std::string> haptic = node({sibling_program("haptic_node"), o.scene});
  if (o.seconds > 0) haptic.insert(haptic.end(), {"--seconds", fmt::format("{}", o.seconds)});
  if (plan.web) haptic.push_back("--hands");
  nodes.start("haptic_node", haptic);
  return true;
}

/// Of a run that nobody has seen.
void say_where_to_look(const Scene& scene, const RunOptions& o) {
  const std::string log = log_of(scene, o);
  fmt::print("nothing was shown: --web shows it in a browser, --film FILE.mp4 makes a film{}\n",
             log.empty() ? "" : fmt::format(", `palpate film {} -o FILE.mp4` one of the log", log));
}

void check_port(const std::string& port) {
  if (port.empty() || port == kScenesPort) return;
  int number = 0;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (error != std::errc() || end != port.data() + port.size() || number < 0 || number > 65535)
    throw std::runtime_error(fmt::format("--web: '{}' is no port, 0 to 65535", port));
}

void run(const RunOptions& o) {
  check_port(o.web);
  const Scene scene = load_scene(o.scene, parse_changes(o.set));
  if (scene.tools.empty())
    throw std::runtime_error(fmt::format(
        "{}: the scene has no tool, so nothing is felt; `palpate drive {} --seconds S` lets its tissue move", o.scene,
        o.scene));
  if (!o.keep.empty() && log_of(scene, o).empty())
    throw std::runtime_error("--keep: there is no log; --record names one, or `file` in the scene's [record]");
  keep_files_of(scene, {log_of(scene, o), o.film, o.still, o.summary});
  make_devices(scene.tools, scene.rates.haptic_hz);  // what is wrong with a motion is said before all else
  for (const Body& body : scene.bodies) ensure_archive(scene, body, say_stages(body));
  catch_shutdown_signals();
  std::optional<AtomicFile> summary_file;  // what cannot be written is found before the run
  if (!o.summary.empty()) summary_file.emplace(o.summary);
  const auto begin = Clock::now();
  const DomainClaim claim = claim_domain(scene, o);
  RunNodes nodes(o.json);
  const bool began = start_nodes(nodes, scene, claim.domain(), o);
  while (!shutdown_requested() && nodes.last_runs() && nodes.failure().empty()) {
    nodes.read();
    std::this_thread::sleep_for(20ms);
  }
  nodes.stop();
  if (!began) throw Interrupted("stopped before the run began");

  nlohmann::json summary = nodes.summary();
  summary["scene"] = o.scene;
  summary["title"] = scene.title;
  summary["seconds"] = std::chrono::duration<double>(Clock::now() - begin).count();
  summary["version"] = PALPATE_VERSION;
  if (o.json)
    fmt::print("{}\n", summary.dump());
  else
    print_summary(summary);
  if (summary_file) {
    std::ofstream file(summary_file->handle());
    file << summary.dump(2) << "\n";
    if (!file.flush()) throw std::runtime_error(fmt::format("{}: cannot write the summary", o.summary));
    summary_file->commit();
  }
  nodes.check();
  for (const std::string& said : {interventions_in(summary), untold_steps_in(summary)}) {
    if (said.empty()) continue;
    if (o.strict) throw std::runtime_error(said);
    fmt::print(stderr, "{}\n", said);
  }
  if (const NodePlan plan = plan_of(scene, o); !plan.web && !plan.render && !o.json) say_where_to_look(scene, o);
}

}  // namespace

void add_run_command(cli::Command& app) {
  auto o = std::make_shared<RunOptions>();
  cli::Command run_command = app.add_command("run", "Start the nodes that a scene needs on this machine");
  run_command.add_option("SCENE", o->scene, "Scene file").required();
  add_set_option(run_command, o->set);
  run_command
      .add_option("--seconds", o->seconds,
                  "Stop after so many seconds (default: when a scripted motion ends, with --web never, or Ctrl-C)")
      .positive();
  run_command.add_option("--record", o->record, "Write all topics to this LCM event log").output_file("", {".lcmlog"});
  run_command
      .add_option("--keep", o->keep,
                  "What the log keeps, as `palpate record` has it (default: everything where the run ends by itself "
                  "within 600 s, else enough)")
      .one_of(std::vector<std::string>{"everything", "enough"});
  run_command.add_option("--film", o->film, "Write a film (MP4)").output_file(".mp4");
  run_command.add_option("--still", o->still, "Write a picture (PNG) of the moment of the largest force")
      .output_file(".png");
  run_command
      .add_option(
          "--web", o->web,
          "Show it in browsers, and let people there take its tools; a port in place of the scene's may follow, "
          "0 for any that is free. Runs until Ctrl-C")
      .value_if_any(kScenesPort);
  run_command.add_option("--summary", o->summary, "Write rates, latencies and forces as JSON").output_file(".json");
  run_command.add_option(
      "--domain", o->domain,
      "DDS domain, 0 to 230, in place of the scene's; auto, the default: the scene's, or the first free "
      "one if another run on this host has it");
  run_command.add_option("--keys", o->keys, "Folder of keys in place of the scene's");
  run_command
      .add_option("--processes", o->processes,
                  "Start these although nobody looks. 2: haptic node, and a render node that deforms too; 3: also a "
                  "deformation "
                  "node of its own, which moving tissue always has (default: what --film, --still and --web need)")
      .one_of({2, 3});
  run_command.add_flag("--json", o->json, "Print rates, latencies and forces as one line of JSON");
  run_command.add_flag(
      "--strict", o->strict,
      "Fail if the guards before the hand had to step in, a node refused a message, or a log lacks steps");
  run_command.may_be_quiet();
  run_command.examples({"palpate run scenes/liver.toml --web",
                        "palpate run scenes/liver.toml --set body.young=8000 --film out/stiff.mp4",
                        "palpate run scenes/hepatectomy.toml --record out/cut.lcmlog --film out/cut.mp4"});
  run_command.does([o, run_command] {
    o->force = run_command.given("--force");
    run(*o);
  });
}

}  // namespace palpate
