#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <csignal>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <thread>

#include "common/bus/log_reader.hpp"
#include "idl/topics.hpp"
#include "tests/bus/domain.hpp"
#include "tests/sanitized.hpp"
#include "tests/tools/comes_within.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using nlohmann::json;
using namespace testing;

/// The files that a whole session of `palpate run` leaves.
struct Session {
  explicit Session(const fs::path& folder)
      : film(folder / "session.mp4"),
        still(folder / "session.png"),
        log(folder / "session.lcmlog"),
        summary(folder / "session.json") {}
  std::vector<std::string> arguments(const LoopbackScene& scene, int processes) const {
    return {program("palpate"),
            "run",
            scene.scene(),
            "--processes",
            std::to_string(processes),
            "--domain",
            std::to_string(testing::own_domain()),
            "--film",
            film,
            "--still",
            still,
            "--record",
            log,
            "--summary",
            summary};
  }
  fs::path film, still, log, summary;
};

std::string joined(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += word + " ";
  return line;
}

/// Seconds of a film that ffprobe can read to its end.
double film_seconds(const fs::path& film) {
  const auto probe = run_program(
      "ffprobe -v error -count_frames -show_entries stream=nb_read_frames:format=duration -of json " + film.string());
  EXPECT_EQ(probe.status, 0);
  EXPECT_EQ(probe.err, "");
  const json found = json::parse(probe.out);
  EXPECT_GT(std::stoi(found["streams"][0]["nb_read_frames"].get<std::string>()), 10);
  return std::stod(found["format"]["duration"].get<std::string>());
}

/// Processes whose command line names something in the folder.
std::vector<std::string> processes_of(const fs::path& folder) {
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::string line = text_of(entry.path() / "cmdline");
    std::replace(line.begin(), line.end(), '\0', ' ');
    if (line.find(folder.string()) != std::string::npos) found.push_back(line);
  }
  return found;
}

/// The process of a program of that folder's session; 0 if it does not run.
pid_t process_of(const fs::path& folder, const std::string& name) {
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string line = text_of(entry.path() / "cmdline");
    if (line.find(folder.string()) != std::string::npos && fs::path(line.substr(0, line.find('\0'))).filename() == name)
      return std::stoi(entry.path().filename());
  }
  return 0;
}

/// Forces in a log that is still written.
int forces_in(const fs::path& log) {
  if (!fs::exists(log) || fs::file_size(log) == 0) return 0;
  LogReader reader(log);
  ForceState force;
  int count = 0;
  for (LogEvent event; reader.next(event);) count += event.read(topics::force_state, force);
  return count;
}

json info_of(const fs::path& log) {
  const auto info = run_program(program("palpate") + " info " + log.string() + " --json");
  EXPECT_EQ(info.status, 0) << info.err;
  return json::parse(info.out);
}

void expect_whole_session(const Session& session) {
  for (const fs::path& file : {session.film, session.still, session.log, session.summary}) {
    ASSERT_TRUE(fs::exists(file)) << file;
    EXPECT_GT(fs::file_size(file), 100u) << file;
  }
  EXPECT_EQ(text_of(session.still).substr(0, 4), "\x89PNG");
  EXPECT_GT(film_seconds(session.film), 0.5);
}

class ToolsSession : public ::testing::TestWithParam<int> {};

TEST_P(ToolsSession, ARunLeavesFilmStillSummaryAndALogThatVerifies) {
  const LoopbackScene scene(fmt::format("session{}", GetParam()), kLinear);
  const Session session(scene.folder());
  const auto run = run_program(joined(session.arguments(scene, GetParam())) + "--seconds 2.3");
  ASSERT_EQ(run.status, 0) << run.err;
  expect_whole_session(session);

  const json summary = json::parse(text_of(session.summary));
  EXPECT_GT(summary["haptic_node"]["rate_hz"].get<double>(), 500);
  EXPECT_GT(summary["haptic_node"]["force_max_n"].get<double>(), 0.05);
  EXPECT_GT(summary["render_node"]["frames"].get<int>(), 10);
  EXPECT_EQ(summary["recorder"]["lost"], 0);
  EXPECT_EQ(summary.contains("deform_node"), GetParam() == 3);

  const json topics = info_of(session.log)["topics"];
  for (const char* topic : {"tool_state", "contact_state", "force_state", "haptic_keyframe", "node_status"})
    EXPECT_TRUE(topics.contains(std::string("palpate/") + topic)) << topics.dump();
  EXPECT_EQ(topics.contains("palpate/surface_state"), GetParam() == 3) << topics.dump();

  const auto verified = run_program(program("palpate") + " replay " + session.log.string() + " --verify");
  EXPECT_EQ(verified.status, 0) << verified.err;
  EXPECT_NE(verified.out.find("equal bit for bit"), std::string::npos) << verified.out;
}

TEST_P(ToolsSession, CtrlCEndsARunWithWholeFilesAndNoChildLeft) {
  const LoopbackScene scene(fmt::format("interrupted{}", GetParam()), kLinear);
  scene.write("motion.csv",
              "time,yaw,pitch,depth,roll,grip\n0,0,0,0.17,0,0\n1,0,0,0.198,0,0\n60,0.06,0.02,0.199,0.3,0\n");
  const Session session(scene.folder());
  ChildProcess run("palpate", session.arguments(scene, GetParam()));
  ASSERT_TRUE(comes_within(30s, [&] { return run.running() && forces_in(session.log) > 100; }));
  EXPECT_GT(processes_of(scene.folder()).size(), static_cast<std::size_t>(GetParam()))
      << "the run, the nodes and the recorder";
  run.interrupt();
  ASSERT_TRUE(run.wait(20s));
  EXPECT_EQ(run.status(), 0);
  EXPECT_EQ(processes_of(scene.folder()), std::vector<std::string>{});

  expect_whole_session(session);
  const json info = info_of(session.log);
  EXPECT_TRUE(info["complete"].get<bool>()) << info.dump();
  EXPECT_GT(info["topics"]["palpate/force_state"]["samples"].get<int>(), 100);
  EXPECT_TRUE(json::parse(text_of(session.summary))["haptic_node"].is_object());
}

// At any moment from the first node's start to the last one's.
TEST_P(ToolsSession, CtrlCWhileTheNodesStartEndsARunInOrder) {
  const LoopbackScene scene(fmt::format("stopped-early{}", GetParam()), kLinear);
  ASSERT_EQ(run_program(program("palpate") + " precompute " + scene.scene()).status, 0);
  const Session session(scene.folder());
  for (const auto moment : {0ms, 30ms, 100ms, 250ms}) {
    ChildProcess run("palpate", session.arguments(scene, GetParam()));
    while (run.running() && processes_of(scene.folder()).size() < 2) std::this_thread::sleep_for(1ms);
    std::this_thread::sleep_for(moment);
    run.interrupt();
    ASSERT_TRUE(run.wait(30s));
    EXPECT_LE(run.status(), 1) << moment.count()
                               << " ms after the first node: 1 where the haptic node was not yet there";
    for (const auto& left : fs::directory_iterator(scene.folder()))
      EXPECT_EQ(left.path().string().find(".tmp-"), std::string::npos) << left.path();
    EXPECT_TRUE(comes_within(5s, [&] { return processes_of(scene.folder()).empty(); }))
        << "a film's encoder ends once nothing more comes: "
        << fmt::format("{}", fmt::join(processes_of(scene.folder()), "; "));
  }
}

INSTANTIATE_TEST_SUITE_P(Processes, ToolsSession, ::testing::Values(2, 3));

constexpr const char* kLongRest = "time,yaw,pitch,depth,roll,grip\n0,0,0,0.17,0,0\n60,0,0,0.17,0,0\n";

TEST(SessionTest, ThreeProcessesTellSurfacesAlsoWhereNothingIsDrawn) {
  const LoopbackScene scene("undrawn", kLinear);
  const std::string text = text_of(scene.scene());
  scene.write("scene.toml", text.substr(0, text.find("[render]")));
  const fs::path file = scene.folder() / "summary.json";
  const auto run = run_program(fmt::format("{} run {} --processes 3 --seconds 0.5 --domain {} --summary {}",
                                           program("palpate"), scene.scene(), testing::own_domain(), file.string()));
  ASSERT_EQ(run.status, 0) << run.err;
  const json summary = json::parse(text_of(file));
  ASSERT_TRUE(summary.contains("deform_node")) << summary.dump();
  EXPECT_GT(summary["deform_node"]["frames"].get<int>(), 10);
  EXPECT_FALSE(summary.contains("render_node"));
}

TEST(SessionTest, APictureThatStandsInTheFilmIsCountedAndSaid) {
  const LoopbackScene scene("stand", kLinear);
  scene.write("motion.csv", kLongRest);
  const Session session(scene.folder());
  ASSERT_EQ(run_program(program("palpate") + " precompute " + scene.scene()).status, 0);
  std::vector<std::string> command = session.arguments(scene, 2);
  command.insert(command.end(), {"--seconds", "6"});
  ChildProcess run("palpate", command);
  ASSERT_TRUE(comes_within(20s, [&] { return forces_in(session.log) > 200; })) << "the film runs";
  const pid_t render = process_of(scene.folder(), "render_node");
  ASSERT_GT(render, 0);
  kill(render, SIGSTOP);
  std::this_thread::sleep_for(1s);
  kill(render, SIGCONT);
  ASSERT_TRUE(run.wait(60s));
  ASSERT_EQ(run.status(), 0);
  const json drawn = json::parse(text_of(session.summary))["render_node"];
  EXPECT_GE(drawn["film_longest_stand_s"].get<double>(), 0.95);
  EXPECT_GE(drawn["film_repeated"].get<int>(), 28);
  std::string said;
  for (const std::string& line : run.take_lines())
    if (line.starts_with("film ")) said = line;
  EXPECT_NE(said.find(fmt::format("longest stand {:.2f} s", drawn["film_longest_stand_s"].get<double>())),
            std::string::npos)
      << said;
}

TEST(SessionTest, ASecondRunInOneDomainIsToldSoAndTakesAnotherOneByItself) {
  const LoopbackScene scene("domains", kLinear);
  scene.write("motion.csv", kLongRest);
  // Beyond those that tests have of their own: the second run takes the next one.
  const std::string domain = std::to_string(100 + testing::own_domain()),
                    run = program("palpate") + " run " + scene.scene();
  ChildProcess first("palpate", {program("palpate"), "run", scene.scene(), "--domain", domain});
  std::this_thread::sleep_for(1s);
  const auto same = run_program(run + " --domain " + domain);
  EXPECT_EQ(same.status, 1);
  EXPECT_NE(same.err.find("domain " + domain + " is another run's"), std::string::npos) << same.err;
  scene.replace("[render]", "[network]\ndomain = " + domain + "\n\n[render]");
  const auto other = run_program(run + " --seconds 1");
  EXPECT_EQ(other.status, 0) << other.err;
  EXPECT_NE(other.err.find("domain " + domain + " is another run's on this host; this one takes domain"),
            std::string::npos)
      << other.err;
  EXPECT_TRUE(first.running());
  first.interrupt();
  ASSERT_TRUE(first.wait(30s));
  EXPECT_EQ(first.status(), 0);
  const auto word = run_program(run + " --domain one");
  EXPECT_EQ(word.status, 1);
  EXPECT_NE(word.err.find("give a number from 0 to 230, or auto"), std::string::npos) << word.err;
}

TEST(SessionTest, ASecondHapticNodeInOneDomainDoesNotStart) {
  const LoopbackScene scene("owners", kLinear);
  scene.write("motion.csv", kLongRest);
  const std::vector<std::string> command{program("haptic_node"), scene.scene(), "--domain",
                                         std::to_string(testing::own_domain())};
  ASSERT_EQ(run_program(program("palpate") + " precompute " + scene.scene()).status, 0);
  std::vector<std::string> supervised = command;
  supervised.push_back("--supervised");
  ChildProcess owner("haptic_node", supervised);
  ASSERT_TRUE(comes_within(20s, [&] { return !owner.take_lines().empty(); })) << "it is ready, and looks for others";
  std::this_thread::sleep_for(1500ms);
  const auto second = run_program(joined(command));
  EXPECT_EQ(second.status, 1);
  EXPECT_NE(second.err.find("a second owner would fight with it"), std::string::npos) << second.err;
  const LoopbackScene other("others", kLinear, 6000);
  ASSERT_EQ(run_program(program("palpate") + " precompute " + other.scene()).status, 0);
  const auto third = run_program(
      fmt::format("{} {} --seconds 0.5 --domain {}", program("haptic_node"), other.scene(), testing::own_domain()));
  EXPECT_EQ(third.status, 1);
  EXPECT_NE(third.err.find("a second owner would fight with it"), std::string::npos)
      << "drivers know of no scenes: " << third.err;
  EXPECT_TRUE(owner.running());
  owner.interrupt();
  ASSERT_TRUE(owner.wait(30s));
  EXPECT_EQ(owner.status(), 0);
}

TEST(SessionTest, ARunThatEndsUnderAForceLetsItGoAndIsComputedAgain) {
  const LoopbackScene scene("pressed", kLinear);
  const fs::path log = scene.folder() / "run.lcmlog";
  const auto run = run_program(fmt::format("{} run {} --strict --seconds 1.2 --domain {} --record {}",
                                           program("palpate"), scene.scene(), testing::own_domain(), log.string()));
  EXPECT_EQ(run.status, 0) << run.err;
  LogReader reader(log);
  ForceState force;
  ToolState tool;
  double largest = 0;
  for (LogEvent event; reader.next(event);) {
    event.read(topics::tool_state, tool);
    if (event.read(topics::force_state, force)) largest = std::max(largest, -force.depth_force);
  }
  EXPECT_GT(largest, 0.2);
  EXPECT_EQ(force.depth_force, 0);
  EXPECT_EQ(force.force, (std::array<double, 3>{}));
  EXPECT_TRUE(tool.silent);
  const auto verified = run_program(program("palpate") + " replay --verify " + log.string());
  EXPECT_EQ(verified.status, 0) << verified.out << verified.err;
}

/// Whether a log holds a status of a node of this role with these words in it.
bool status_says(const fs::path& log, const std::string& role, const std::string& words) {
  LogReader reader(log);
  NodeStatus status;
  for (LogEvent event; reader.next(event);)
    if (event.read(topics::node_status, status) && status.role == role && status.text.find(words) != std::string::npos)
      return true;
  return false;
}

TEST(OverloadTest, TissueThatNoMachineKeepsUpWithIsSaidToFallBehind) {
  // 35,000 tetrahedra, of which a tick has 100 us.
  const LoopbackScene scene("overload", "[body.touchable]\nbox = [[-0.01, -0.01, -0.001], [0.01, 0.01, 0.001]]\n");
  write_tet_mesh(make_block({-0.05, -0.05, -0.05}, {0.05, 0.05, 0}, {22, 22, 12}), scene.folder() / "block.msh");
  scene.replace("quasi_static", "tensor_mass");
  scene.replace("[[tool]]", "[rates]\nhaptic_hz = 10000\n\n[[tool]]");
  scene.write("motion.csv", kLongRest);
  const fs::path log = scene.folder() / "session.lcmlog";
  const auto run = run_program(fmt::format("{} run {} --processes 3 --seconds 4 --domain {} --record {}",
                                           program("palpate"), scene.scene(), testing::own_domain(), log.string()));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.err.find("the tissue falls behind by"), std::string::npos) << run.err;
  EXPECT_TRUE(status_says(log, "deform", "the tissue falls behind by"));
}

constexpr std::uint64_t kPressed = 4500;  // steps: pressed for long, and no node has ended yet

/// The force on the only tool in a log [N]: the largest, that of step kPressed or of the last before it, and the
/// largest change in a step.
struct Felt {
  double largest = 0, held = 0, change = 0;
};

Felt felt_in(const fs::path& log) {
  LogReader reader(log);
  Felt felt;
  ForceState before, force;
  for (LogEvent event; reader.next(event);) {
    if (!event.read(topics::force_state, force)) continue;
    const Eigen::Map<const Eigen::Vector3d> now(force.force.data()), last(before.force.data());
    felt.largest = std::max(felt.largest, now.norm());
    if (force.step == before.step + 1) felt.change = std::max(felt.change, (now - last).norm());
    if (force.step <= kPressed) felt.held = now.norm();
    before = force;
  }
  return felt;
}

/// Of what a node had to do, the share that it left out.
double left_out(const json& summary, const char* node, const char* done) {
  const double missed = summary[node]["missed"].get<double>();
  return missed / (missed + summary[node][done].get<double>());
}

/// Shares that were left out, and the force [N] beside that of a run in lock step.
struct Overloaded {
  double pictures = 0, tissue = 0, steps = 1;
  Felt felt, undisturbed;
  std::string said;
};

/// A block of moving tissue under a tool that comes down on it within 1.5 s and stands there. One with `cells` is run
/// on one core, beside so many busy loops, for as long as the loop's steps are left out, three times at most: a host
/// that stands still does so too, now and then. Nothing without the right to realtime priority.
std::optional<Overloaded> on_one_core(std::array<int, 3> cells, int busy_loops) {
  const LoopbackScene scene("one_core",
                            "[body.touchable]\nbox = [[-0.02, -0.02, -0.001], [0.02, 0.02, 0.001]]\n\n"
                            "[body.dynamic]\ndamping = 20\n");
  write_tet_mesh(make_block({-0.05, -0.05, -0.05}, {0.05, 0.05, 0}, cells), scene.folder() / "block.msh");
  scene.replace("quasi_static", "tensor_mass");
  scene.write("motion.csv", "time,yaw,pitch,depth,roll,grip\n0,0,0,0.185,0,0\n1.5,0,0,0.197,0,0\n60,0,0,0.197,0,0\n");
  const fs::path alone = scene.folder() / "alone.lcmlog";
  std::string said;
  EXPECT_EQ(
      run_command(fmt::format("{} drive {} --seconds 2 --log {}", program("palpate"), scene.scene(), alone.string()),
                  &said),
      0)
      << said;
  Overloaded found{.undisturbed = felt_in(alone)};
  std::vector<ChildProcess> busy;
  for (int i = 0; i < busy_loops; ++i)
    busy.emplace_back("busy",
                      std::vector<std::string>{"/usr/bin/taskset", "-c", "0", "/bin/sh", "-c", "while :; do :; done"});
  const Session session(scene.folder());
  for (int turn = 0; turn < 3 && found.steps > 0.02; ++turn) {
    const auto run = run_program("taskset -c 0 " + joined(session.arguments(scene, 3)) + "--force --seconds 5");
    EXPECT_EQ(run.status, 0) << run.err;
    if (run.status != 0 || run.err.find("realtime scheduling: FIFO") == std::string::npos) return {};
    const json summary = json::parse(text_of(session.summary));
    found.pictures = left_out(summary, "render_node", "frames");
    found.tissue = left_out(summary, "deform_node", "ticks");
    found.steps = left_out(summary, "haptic_node", "ticks");
    found.felt = felt_in(session.log);
    found.said = run.err;
    fmt::print(
        "left out: {:.1f} % of the pictures, {:.1f} % of the tissue's ticks, {:.2f} % of the loop's steps; "
        "{:.4f} N at most, {:.4f} N held, by {:.4f} N a step; undisturbed {:.4f} N, {:.4f} N, {:.4f} N\n",
        100 * found.pictures, 100 * found.tissue, 100 * found.steps, found.felt.largest, found.felt.held,
        found.felt.change, found.undisturbed.largest, found.undisturbed.held, found.undisturbed.change);
  }
  return found;
}

void expect_felt_as(const Felt& felt, const Felt& undisturbed) {
  EXPECT_GT(undisturbed.held, 0.1);
  EXPECT_LT(felt.largest, 1.1 * undisturbed.largest);
  EXPECT_LT(felt.change, 0.1 * undisturbed.held);
  EXPECT_NEAR(felt.held, undisturbed.held, 0.1 * undisturbed.held);
}

TEST(OverloadTest, BesideBusyLoopsPicturesAreLeftOutFirstAndAPressIsFelt) {
  if (kSanitized) GTEST_SKIP() << "nothing is in time there";
  const auto found = on_one_core({8, 8, 4}, 2);
  if (!found) GTEST_SKIP() << "no right to realtime priority";
  EXPECT_LT(found->steps, 0.02);
  EXPECT_GT(found->pictures, 0.2);
  EXPECT_LT(found->tissue, 0.5 * found->pictures);
  expect_felt_as(found->felt, found->undisturbed);
}

// The kernel stops all realtime threads of a core for 50 ms of each second in which they leave it nothing.
TEST(OverloadTest, OnOneCoreTheTissueFallsBehindTheForceDoesNotAndAPressIsFelt) {
  if (kSanitized) GTEST_SKIP() << "nothing is in time there";
  const auto found = on_one_core({30, 30, 16}, 0);
  if (!found) GTEST_SKIP() << "no right to realtime priority";
  EXPECT_LT(found->steps, 0.02);
  EXPECT_GT(found->tissue, 0.1);
  EXPECT_NE(found->said.find("the tissue falls behind by"), std::string::npos) << found->said;
  if (found->tissue < 0.8)  // beyond, models come too late to be felt
    expect_felt_as(found->felt, found->undisturbed);
}

// From both at once to the second one while the first is about to begin.
TEST(SessionTest, OfTwoHapticNodesWithinASecondExactlyOneStays) {
  const LoopbackScene scene("rivals", kLinear);
  scene.write("motion.csv", kLongRest);
  ASSERT_EQ(run_program(program("palpate") + " precompute " + scene.scene()).status, 0);
  const std::vector<std::string> command{program("haptic_node"), scene.scene(), "--domain",
                                         std::to_string(testing::own_domain()), "--supervised"};
  for (int i = 0; i < 10; ++i) {
    SCOPED_TRACE(fmt::format("{} ms apart", 100 * i));
    ChildProcess first("haptic_node", command);
    std::this_thread::sleep_for(i * 100ms);
    ChildProcess second("haptic_node", command);
    ASSERT_TRUE(comes_within(30s, [&] { return !first.running() || !second.running(); })) << "both stay";
    std::this_thread::sleep_for(1s);
    ASSERT_NE(first.running(), second.running()) << "neither stays";
    ChildProcess& stays = first.running() ? first : second;
    EXPECT_EQ((first.running() ? second : first).status(), 1);
    stays.interrupt();
    ASSERT_TRUE(stays.wait(30s));
    EXPECT_EQ(stays.status(), 0);
  }
}

}  // namespace
}  // namespace palpate
