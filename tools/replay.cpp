#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/bus/log_reader.hpp"
#include "common/bus/runs_at_once.hpp"
#include "common/bus/topic_named.hpp"
#include "common/cli/progress.hpp"
#include "common/describe/printable.hpp"
#include "common/realtime/settings.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/scene/find_archive.hpp"
#include "deform_node/verify_tissue.hpp"
#include "haptic_node/verify.hpp"
#include "tools/log_player.hpp"
#include "tools/logs/log_files.hpp"
#include "tools/logs/log_sender.hpp"
#include "tools/replay_guard.hpp"
#include "tools/shared/commands.hpp"
#include "tools/shared/network_options.hpp"

namespace palpate {
namespace {

struct ReplayOptions {
  SystemNetwork network;
  PlaySettings play;
  std::string file, data;
  bool verify = false, json = false;
};

constexpr int kPlayerPriority = 30;  // below a node's loop and its publisher

nlohmann::ordered_json json_of(const std::string& file, const VerifyReport& report, const TissueReport& tissue,
                               const std::string& two_runs) {
  using Json = nlohmann::ordered_json;
  std::vector<std::string> gaps = report.gaps;
  gaps.insert(gaps.end(), tissue.gaps.begin(), tissue.gaps.end());
  return {{"file", file},
          {"verified", report.verified() && tissue.mismatch.empty() && tissue.gaps.empty()},
          {"steps", report.steps},
          {"forces", report.forces},
          {"steps_before_keyframe", report.before_keyframe},
          {"tasks", report.tasks},
          {"tissue_ticks", tissue.ticks},
          {"code_path", report.code_path},
          {"complete", report.damage.empty()},
          {"mismatch", report.mismatch.empty() ? tissue.mismatch : report.mismatch},
          {"gaps", gaps},
          {"lost", report.footer ? Json(report.footer->lost) : Json(nullptr)},
          {"loss_reason", report.footer ? report.footer->error : ""},
          {"runs_at_once", two_runs},
          {"damage", report.damage}};
}

/// What else than the steps may have made a difference.
std::string doubt(const Scene& scene, const std::vector<std::string>& computed) {
  std::vector<std::string> made;
  for (const Body& body : scene.bodies) {
    if (archive_path(body).empty()) continue;
    const bool here = std::ranges::find(computed, name_of(body)) != computed.end();
    made.push_back(fmt::format("those of '{}' were computed {}by {}", name_of(body), here ? "on this host " : "",
                               find_archive(scene, body, ArchivePart::header).software));
  }
  if (made.empty()) return {};
  return fmt::format("; tensors have the recorded run's bits only where OpenBLAS took the same kernels for both: {}",
                     fmt::join(made, ", "));
}

/// Throws std::runtime_error where the recorded forces are not all come to again.
void require_forces(const std::string& file, const VerifyReport& report, const std::string& doubt) {
  if (!report.mismatch.empty())
    throw std::runtime_error(fmt::format("{}: the forces differ: {}{}", file, report.mismatch, doubt));
  if (!report.verified())
    throw std::runtime_error(fmt::format(
        "{}: not verified as a whole: {} forces of {} steps are equal bit for bit, {} places cannot be verified", file,
        report.forces, report.steps, report.gaps.size()));
}

void require_tissue(const std::string& file, const TissueReport& tissue, const std::string& doubt) {
  if (!tissue.mismatch.empty())
    throw std::runtime_error(fmt::format("{}: the tissue differs: {}{}", file, tissue.mismatch, doubt));
  if (!tissue.gaps.empty())
    throw std::runtime_error(
        fmt::format("{}: the tissue is not verified as a whole: {} ticks are equal bit for bit", file, tissue.ticks));
}

void verify(const ReplayOptions& o) {
  catch_shutdown_signals();
  const LoggedScene logged(o.file, o.data);
  const std::vector<std::string> computed = logged.ensure_archives();
  const VerifyReport report = verify_log(o.file, logged.scene());
  if (!report.damage.empty()) fmt::print(stderr, "palpate: {}\n", report.damage);
  if (report.footer && report.footer->lost > 0)
    fmt::print(stderr, "palpate: {}: the recorder lost {} messages: {}\n", o.file, report.footer->lost,
               printable(report.footer->error));
  const std::string two_runs = runs_at_once(o.file);
  if (!two_runs.empty()) fmt::print(stderr, "palpate: {}: {}; each is verified by itself\n", o.file, two_runs);
  for (const std::string& gap : report.gaps) fmt::print(stderr, "palpate: {}: {}\n", o.file, gap);
  TissueReport tissue;
  if (report.verified()) tissue = verify_tissue(o.file, logged.scene());  // on the code path that verify_log() took up
  for (const std::string& gap : tissue.gaps) fmt::print(stderr, "palpate: {}: {}\n", o.file, gap);
  if (o.json) fmt::print("{}\n", json_of(o.file, report, tissue, two_runs).dump());
  const bool differs = !report.mismatch.empty() || !tissue.mismatch.empty();
  const std::string doubts = differs ? doubt(logged.scene(), computed) : std::string();
  require_forces(o.file, report, doubts);
  if (!o.json) {
    if (!computed.empty())
      fmt::print("{}: with tensors of '{}' that were computed on this host\n", o.file, fmt::join(computed, "', '"));
    fmt::print("{}: verified: {} forces of {} steps are equal bit for bit, on code path {}\n", o.file, report.forces,
               report.steps, report.code_path);
    if (report.before_keyframe > 0)
      fmt::print("{}: not verified: {} steps that were recorded before the first keyframe of their run\n", o.file,
                 report.before_keyframe);
    if (report.tasks > 0)
      fmt::print("{}: verified: {} records of the task are equal bit for bit\n", o.file, report.tasks);
  }
  require_tissue(o.file, tissue, doubts);
  if (tissue.ticks > 0 && !o.json)
    fmt::print("{}: verified: {} ticks of the tissue end in the recorded state, bit for bit\n", o.file, tissue.ticks);
}

nlohmann::ordered_json json_of(const ReplayOptions& o, const PlayReport& report) {
  const Percentiles pace = percentiles_us(report.pace);
  return {
      {"file", o.file},
      {"complete", report.complete},
      {"seconds", report.seconds},
      {"played", report.played},
      {"skipped", report.skipped},
      {"leaps", report.leaps},
      {"pace_us", {{"p50", pace.p50}, {"p90", pace.p90}, {"p99", pace.p99}, {"p999", pace.p999}, {"max", pace.max}}},
      {"damage", report.damage}};
}

/// A scene that is named gives its network; the log of another one is played all the same.
void say_another_scene(const ReplayOptions& o) {
  if (o.network.scene.empty()) return;
  LogReader log(o.file);
  for (LogEvent event; log.header().scene_hash.empty() && log.next(event);) {
  }
  const std::string& hash = log.header().scene_hash;
  if (!hash.empty() && hash != scene_hash(load_scene(o.network.scene)))
    fmt::print(stderr, "palpate: {} is of another scene than {}, whose [network] alone is used\n", o.file,
               o.network.scene);
}

void play(const ReplayOptions& o) {
  catch_shutdown_signals();
  const std::set<std::string> topics = topics_in(o.file, o.play.topics);
  for (const std::string& wanted : o.play.topics)
    if (const std::string name = topic_named(wanted); !topics.contains(name))
      throw std::runtime_error(fmt::format("{}: holds no sample of {}", o.file, name));
  say_another_scene(o);
  const auto bus = make_dds_bus(o.network);
  if (o.network.keys.empty())  // with keys a player hears nobody
    look_who_is_there(*bus, topics);
  request_realtime(
      {.priority = kPlayerPriority, .lock_memory = false});  // where permitted; after the bus has made its threads
  const PlayReport report = play_log(o.file, *bus, o.play, [&](double seconds) {
    cli::say_in_place(fmt::format("{:9.2f} s", seconds));
    return !shutdown_requested();
  });
  cli::say_in_place("");
  if (o.json) {
    fmt::print("{}\n", json_of(o, report).dump());
    return stop_if_interrupted();
  }
  if (!report.damage.empty()) fmt::print(stderr, "palpate: {}\n", report.damage);
  if (report.leaps > 0)
    fmt::print(stderr, "palpate: {}: {} leaps of its times by more than an hour are played at once\n", o.file,
               report.leaps);
  const Percentiles pace = percentiles_us(report.pace);
  fmt::print(
      "{}: {} of {:.2f} s: {} messages to domain {}, {} left out\npaced: median {:.1f} us, p99 {:.1f} us after the "
      "recorded times\n",
      o.file, report.complete ? "all" : "stopped at the first", report.seconds, report.played, o.network.domain,
      report.skipped, pace.p50, pace.p99);
  stop_if_interrupted();
}

}  // namespace

void add_replay_command(cli::Command& app) {
  auto o = std::make_shared<ReplayOptions>();
  cli::Command command = app.add_command("replay", "Play a topic log back to DDS, or verify it");
  command.add_option("LOG", o->file, "LCM event log").required();
  command.add_option("--speed", o->play.speed, "2 plays twice as fast").positive().show_default();
  command.add_option("--topic", o->play.topics, "Play this topic alone; may be repeated");
  add_system_options(command, o->network, "player");
  command.add_flag("--json", o->json, "Print what was played and how well paced, or what was verified, as JSON");
  const cli::Option verifies =
      command
          .add_flag(
              "--verify", o->verify,
              "Compute every recorded haptic step, and every tick of moving tissue, again and require the same bits")
          .excludes({"--speed", "--topic", "--scene"});
  command
      .add_option("--data", o->data,
                  "Folder for the files that the log brings along, and with those that are too large for it")
      .needs(verifies);
  command.tells_progress();
  command.examples(
      {"palpate replay out/liver.lcmlog --verify", "palpate replay out/liver.lcmlog --speed 0.5 --topic force_state"});
  command.does([o, command] {
    if (o->verify) return verify(*o);
    take_scene(command, o->network);
    play(*o);
  });
}

}  // namespace palpate
