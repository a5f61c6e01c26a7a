#include "tests/tools/session.hpp"

#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "common/bus/dds_bus.hpp"
#include "common/bus/log_reader.hpp"
#include "idl/topics.hpp"
#include "tests/tools/comes_within.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using nlohmann::json;
using namespace testing;

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

TEST_P(ToolsSession, ANodeThatIsKilledIsNamedAndTheOthersFiguresAreKept) {
  const LoopbackScene scene(fmt::format("killed{}", GetParam()), kLinear);
  scene.write("motion.csv", kLongRest);
  const Session session(scene.folder());
  const fs::path said = scene.folder() / "said";
  ChildProcess run(
      "palpate",
      {"/bin/sh", "-c", fmt::format("exec {} 2>{}", joined(session.arguments(scene, GetParam())), said.string())});
  ASSERT_TRUE(comes_within(30s, [&] { return run.running() && forces_in(session.log) > 100; }));
  kill(process_of(scene.folder(), "render_node"), SIGKILL);
  ASSERT_TRUE(run.wait(30s));
  EXPECT_EQ(run.status(), 1);
  EXPECT_NE(text_of(said).find("render_node was killed by signal 9"), std::string::npos) << text_of(said);
  EXPECT_TRUE(json::parse(text_of(session.summary))["haptic_node"].is_object());
  for (const auto& left : fs::directory_iterator(scene.folder()))
    EXPECT_FALSE(left.path().filename().string().starts_with("session.mp4")) << left.path();
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
    EXPECT_TRUE(run.status() == 0 || run.status() == 130)
        << run.status() << ", " << moment.count()
        << " ms after the first node: 130 where the haptic node was not yet there";
    for (const auto& left : fs::directory_iterator(scene.folder()))
      EXPECT_EQ(left.path().string().find(".tmp-"), std::string::npos) << left.path();
    EXPECT_TRUE(comes_within(5s, [&] { return processes_of(scene.folder()).empty(); }))
        << "a film's encoder ends once nothing more comes: "
        << fmt::format("{}", fmt::join(processes_of(scene.folder()), "; "));
  }
}

INSTANTIATE_TEST_SUITE_P(Processes, ToolsSession, ::testing::Values(2, 3));

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
  ASSERT_EQ(run_program(program("palpate") + " precompute " + scene.scene()).status, 0);
  ChildProcess first("palpate", {program("palpate"), "run", scene.scene(), "--domain", domain});
  ASSERT_TRUE(comes_within(30s, [&] { return process_of(scene.folder(), "haptic_node") > 0; }))
      << "it has the domain before it starts nodes";
  const auto same = run_program(run + " --domain " + domain);
  EXPECT_EQ(same.status, 1);
  EXPECT_NE(same.err.find("domain " + domain + " is another run's"), std::string::npos) << same.err;
  scene.replace("[render]", "[network]\ndomain = " + domain + "\n\n[render]");
  const auto other = run_program(run + " --seconds 1");
  EXPECT_EQ(other.status, 0) << other.err;
  EXPECT_NE(other.err.find("domain " + domain + " is another's on this host; this one takes domain"), std::string::npos)
      << other.err;
  EXPECT_TRUE(first.running());
  first.interrupt();
  ASSERT_TRUE(first.wait(30s));
  EXPECT_EQ(first.status(), 0);
  const auto word = run_program(run + " --domain one");
  EXPECT_EQ(word.status, 1);
  EXPECT_NE(word.err.find("give a number from 0 to 230, or auto"), std::string::npos) << word.err;
}

TEST(SessionTest, ARunTakesAnotherDomainThanAHapticNodesThatWasStartedByHand) {
  const LoopbackScene scene("by-hand", kLinear);
  scene.write("motion.csv", kLongRest);
  const int domain = 100 + testing::own_domain();
  ASSERT_EQ(run_program(program("palpate") + " precompute " + scene.scene()).status, 0);
  ChildProcess node("haptic_node",
                    {program("haptic_node"), scene.scene(), "--domain", std::to_string(domain), "--supervised"});
  ASSERT_TRUE(comes_within(30s, [&] { return !node.take_lines().empty(); })) << "it has the domain before its tools";
  scene.replace("[render]", fmt::format("[network]\ndomain = {}\n\n[render]", domain));
  const auto run = run_program(program("palpate") + " run " + scene.scene() + " --seconds 0.5");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.err.find(fmt::format("domain {} is another's on this host; this one takes domain", domain)),
            std::string::npos)
      << run.err;
  EXPECT_TRUE(node.running());
  node.interrupt();
  ASSERT_TRUE(node.wait(30s));
}

TEST(SessionTest, ASecondHapticNodeInOneDomainDoesNotStart) {
  const LoopbackScene scene("owners", kLinear);
  scene.write("motion.csv", kLongRest);
  const std::vector<std::string> command{program("haptic_node"), scene.scene(), "--domain",
                                         std::to_string(testing::own_domain())};
  ASSERT_EQ(run_program(program("palpate") + " precompute " + scene.scene()).status, 0);
  ChildProcess owner("haptic_node", command);
  const auto bus = make_dds_bus({.domain = testing::own_domain()});
  const auto statuses = bus->reader(topics::node_status, Keep::all);
  ASSERT_TRUE(comes_within(30s, [&] {
    bool began = false;
    while (const auto status = statuses->take()) began |= status->role == "haptic" && status->ticks > 0;
    return began;
  }));
  std::this_thread::sleep_for(3s);  // in which it would still give way to one that began when it did
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
  scene.write("motion.csv", kSlowPress);
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
