#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>

#include "common/cli/progress.hpp"
#include "common/models/content_hash.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/moved_files.hpp"
#include "tools/drive/lock_step.hpp"
#include "tools/drive/run.hpp"
#include "tools/drive/sweep.hpp"
#include "tools/shared/child_process.hpp"
#include "tools/shared/commands.hpp"
#include "tools/shared/jobs_option.hpp"
#include "tools/shared/say_stages.hpp"
#include "tools/shared/set_option.hpp"
#include "tools/shared/shell_line.hpp"

namespace palpate {
namespace {

using namespace drive;

struct DriveOptions {
  std::string scene, log, course, output;
  std::vector<std::string> set, sweep, expect, merge;
  double seconds = 0;
  int jobs = 1, point = -1, points = 0;
  bool csv = false, json = false, tasks = false;
};

std::vector<Expectation> expectations_of(const std::vector<std::string>& arguments) {
  std::vector<Expectation> all;
  for (const std::string& argument : arguments) all.push_back(parse_expectation(argument));
  return all;
}

void put_out(const DriveOptions& o, const std::string& text) {
  if (o.output.empty()) {
    std::fwrite(text.data(), 1, text.size(), stdout);
    return;
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(o.output.c_str(), "w"), std::fclose);
  if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() || std::fflush(file.get()) != 0)
    throw std::runtime_error(fmt::format("{}: cannot be written", o.output));
}

void put_out(const DriveOptions& o, const std::vector<PointResult>& results) {
  std::string lines;
  for (const PointResult& result : results) lines += json_line(result) + "\n";
  put_out(o, o.json ? lines : csv_table(results));
}

RunSettings settings_of(const DriveOptions& o) {
  RunSettings settings{.log = o.log, .course = o.course, .expected = expectations_of(o.expect), .seconds = o.seconds};
  if (o.point < 0)
    settings.progress = [](double time, double wall) {
      cli::say_in_place(fmt::format("{:8.2f} s, {:.1f} times as fast as real time", time, time / wall));
    };
  return settings;
}

/// One point, whatever becomes of it.
PointResult result_of(const DriveOptions& o, const std::vector<SceneChange>& changes) {
  try {
    const Scene scene = load_scene(o.scene, changes);
    keep_files_of(scene, {o.log, o.course, o.output});
    lock_step_devices(scene);  // what is wrong with a motion is said before archives are computed
    for (const Body& body : scene.bodies) ensure_archive(scene, body, say_stages(body));
    catch_shutdown_signals();  // until here Ctrl-C ends it at once
    return run_scene(scene, settings_of(o));
  } catch (const std::runtime_error& error) {
    if (o.point < 0) throw;
    return {.outcome = PointResult::kFailed, .reason = error.what()};
  }
}

void run_one(const DriveOptions& o) {
  const std::vector<SceneChange> changes = parse_changes(o.set);
  PointResult result = result_of(o, changes);
  cli::say_in_place("");
  result.point = std::max(0, o.point);
  result.points = o.points;
  result.changes = changes;
  if (o.csv || o.json)
    put_out(o, std::vector{result});
  else
    put_out(o, text_of(result));
  std::fflush(stdout);
  require_good({result}, 0);
}

/// The command that computes one point of the sweep.
std::vector<std::string> command_of(const DriveOptions& o, const std::vector<SceneChange>& changes, std::size_t point,
                                    std::size_t points) {
  std::vector<std::string> words{sibling_program("palpate"), "drive", std::filesystem::absolute(o.scene).string()};
  for (const SceneChange& change : changes) words.insert(words.end(), {"--set", change.argument()});
  for (const std::string& expected : o.expect) words.insert(words.end(), {"--expect", expected});
  if (o.seconds > 0) words.insert(words.end(), {"--seconds", fmt::format("{}", o.seconds)});
  words.insert(words.end(), {"--json", "--point", std::to_string(point), "--points", std::to_string(points)});
  return words;
}

/// What is wrong with a point is said before the first one runs; what several need is computed once.
void prepare(const DriveOptions& o, const std::vector<std::vector<SceneChange>>& points) {
  expectations_of(o.expect);
  std::vector<Scene> scenes;
  for (const auto& changes : points) {
    scenes.push_back(load_scene(o.scene, changes));
    keep_files_of(scenes.back(), {o.output});
    lock_step_devices(scenes.back());
  }
  if (o.tasks) return;
  std::set<std::string> known;
  for (const Scene& scene : scenes)
    for (const Body& body : scene.bodies)
      if (known.insert(content_hash(body)).second) ensure_archive(scene, body, say_stages(body));
}

void print_tasks(const DriveOptions& o, const std::vector<std::vector<std::string>>& commands) {
  std::string lines;
  for (const auto& command : commands) lines += shell_line(command) + "\n";
  put_out(o, lines);
}

void run_sweep(const DriveOptions& o) {
  std::vector<Axis> axes;
  for (const std::string& text : o.sweep) axes.push_back(parse_axis(text));
  const auto points = grid(parse_changes(o.set), axes);
  prepare(o, points);
  catch_shutdown_signals();  // until here Ctrl-C ends it at once
  std::vector<std::vector<std::string>> commands;
  for (std::size_t i = 0; i < points.size(); ++i) commands.push_back(command_of(o, points[i], i, points.size()));
  if (o.tasks) return print_tasks(o, commands);
  setenv("OMP_NUM_THREADS", "1", 0);  // each run keeps to one core
  std::size_t done = 0;
  std::vector<PointResult> results = run_points(commands, o.jobs, [&](const PointResult& result) {
    std::string set;
    for (const SceneChange& change : points[result.point]) set.append(" ").append(change.argument());
    cli::say(fmt::format("[{}/{}]{}: {} {}", ++done, points.size(), set, result.outcome, result.reason));
  });
  for (PointResult& result : results) {
    result.changes = points[result.point];
    result.points = static_cast<int>(points.size());
  }
  if (results.empty()) throw Interrupted("stopped before one point was done");
  put_out(o, results);
  std::fflush(stdout);
  if (results.size() < points.size())
    throw Interrupted(fmt::format("stopped: {} of {} points are done", results.size(), points.size()));
  require_good(results, points.size());
}

/// What has run already is no more changed by options of a run.
void refuse_beside_merge(const cli::Command& command) {
  for (const char* name :
       {"SCENE", "--set", "--sweep", "--seconds", "--log", "--course", "--jobs", "--tasks", "--point", "--points"})
    if (command.given(name))
      throw std::runtime_error(fmt::format("--merge makes a table of runs that have been made: leave {} out", name));
}

void merge(const DriveOptions& o) {
  const std::vector<Expectation> expected = expectations_of(o.expect);
  std::vector<PointResult> results = read_results({o.merge.begin(), o.merge.end()});
  const std::size_t points = points_of(results);
  for (const std::string& said : drop_repeated(results)) fmt::print(stderr, "palpate: {}\n", said);
  expect_of(results, expected);
  put_out(o, results);
  std::fflush(stdout);
  require_good(results, points);
}

void run(const DriveOptions& o, const cli::Command& command) {
  if (!o.merge.empty()) {
    refuse_beside_merge(command);
    return merge(o);
  }
  if (o.scene.empty()) throw std::runtime_error("drive: give a scene, or results with --merge");
  if (o.sweep.empty() && !o.tasks) return run_one(o);
  if (!o.log.empty() || !o.course.empty())
    throw std::runtime_error("--log and --course are of one run: leave --sweep and --tasks out, or give --set");
  run_sweep(o);
}

}  // namespace

void add_drive_command(cli::Command& app) {
  auto o = std::make_shared<DriveOptions>();
  cli::Command command =
      app.add_command("drive", "Run a scene in lock step, as fast as it goes, and say what it comes to");
  command.add_option("SCENE", o->scene, "Scene file");
  add_set_option(command, o->set);
  command
      .add_option("--sweep", o->sweep,
                  "KEY=VALUE,VALUE,...: a run for each value, of several keys for each combination")
      .one_value_each_time();
  command
      .add_option("--seconds", o->seconds,
                  "Stop after so many seconds of the scene (default: when every motion is over)")
      .positive();
  command
      .add_option("--expect", o->expect,
                  "\"FIGURE<NUMBER\", or <=, >, >=, ==, !=: the exit status is 1 where it is not so")
      .one_value_each_time();
  command.add_flag("--json", o->json, "Print one line of JSON a run");
  command.add_flag("--csv", o->csv, "Print one row of CSV a run (the default of a sweep)").excludes({"--json"});
  command.add_option("-o,--output", o->output, "Write what is printed to this file").output_file("", {".csv", ".json"});
  command.add_option("--log", o->log, "Write a topic log, as a recorder would").output_file("", {".lcmlog"});
  command.add_option("--course", o->course, "Write each step's tips and forces").output_file(".csv");
  add_jobs_option(command, o->jobs, "Runs");
  command.add_flag("--tasks", o->tasks, "Print the command of each run, one a line, and run none");
  command.add_option("--merge", o->merge, "Files with what such commands printed, for one table");
  command.add_option("--point", o->point, "").hidden();
  command.add_option("--points", o->points, "").hidden();
  command.tells_progress();
  command.examples(
      {"palpate drive scenes/liver.toml --expect \"tool.force.max<3\" --expect finite==1",
       "palpate drive scenes/liver.toml --set body.young=8000 --course out/stiff.csv",
       "palpate drive scenes/liver.toml --sweep body.young=4000,8000 --sweep contact.friction=0.1,0.5 -o out/table.csv",
       "palpate drive scenes/liver.toml --sweep body.young=4000,8000 --tasks | parallel > out/results.jsonl",
       "palpate drive --merge out/results.jsonl -o out/table.csv"});
  command.does([o, command] { run(*o, command); });
}

}  // namespace palpate
