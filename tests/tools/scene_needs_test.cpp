// What runs for a scene is what its sections ask for, seen from outside: processes, topics, threads and open files.
#include <dds/dds.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>
#include <utility>

#include "common/bus/dds_entity.hpp"
#include "common/scene/scene.hpp"
#include "tests/bus/domain.hpp"
#include "tests/sanitized.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using Names = std::set<std::string>;
using testing::program;
using testing::text_of;

/// Joins a domain as a stranger and lists the topics that anybody writes or reads there.
class TopicSpy {
 public:
  /// `keys`: a folder with those of an observer; empty: none.
  TopicSpy(int domain, const fs::path& keys)
      : domain_(dds_create_domain(domain, dds_configuration({.domain = domain}).c_str())) {
    const dds_entity_t me = make_participant({.domain = domain, .keys = keys, .role = "observer"});
    for (const dds_entity_t topic : {DDS_BUILTIN_TOPIC_DCPSPUBLICATION, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION})
      readers_.push_back(dds_create_reader(me, topic, nullptr, nullptr));
  }
  ~TopicSpy() { dds_delete(domain_); }
  TopicSpy(const TopicSpy&) = delete;

  const Names& look() {
    for (const dds_entity_t reader : readers_) {
      void* sample = nullptr;
      dds_sample_info_t info;
      for (; dds_take(reader, &sample, &info, 1, 1) > 0; dds_return_loan(reader, &sample, 1)) {
        const std::string name = info.valid_data ? static_cast<dds_builtintopic_endpoint_t*>(sample)->topic_name : "";
        if (name.starts_with("palpate/")) seen_.insert(name.substr(8));
      }
    }
    return seen_;
  }

 private:
  dds_entity_t domain_;
  std::vector<dds_entity_t> readers_;
  Names seen_;
};

/// Programs that `palpate run` has started, with their process numbers.
std::map<std::string, pid_t> children_of(pid_t parent) {
  std::map<std::string, pid_t> children;
  const std::string own = text_of(fmt::format("/proc/{}/cmdline", parent));
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string status = text_of(entry.path() / "status");
    if (status.find(fmt::format("\nPPid:\t{}\n", parent)) == std::string::npos) continue;
    const std::string command = text_of(entry.path() / "cmdline");
    if (command.empty() || command == own) continue;  // it has ended, or is not yet another program
    children[fs::path(command.substr(0, command.find('\0'))).filename()] = std::stoi(entry.path().filename());
  }
  return children;
}

/// Threads of a process that bear its own name: the middleware's have others.
int own_threads(pid_t pid, const std::string& name) {
  int count = 0;
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator(fmt::format("/proc/{}/task", pid), gone))
    count += text_of(entry.path() / "comm") == name + "\n";
  return count;
}

/// Files of the kind that scenes name or write, which a process has open.
Names open_files(pid_t pid) {
  Names files;
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator(fmt::format("/proc/{}/fd", pid), gone)) {
    const fs::path file = fs::read_symlink(entry, gone);
    for (const char* kind : {".h5", ".msh", ".toml", ".csv", ".lcmlog", ".mp4", ".png", ".vtk", ".stl"})
      if (file.extension() == kind) files.insert(file);
  }
  return files;
}

/// What a scene's sections ask for.
struct Needs {
  Names programs{"haptic_node"};
  Names topics{"tool_state", "contact_state", "force_state", "haptic_keyframe",
               "scene",      "node_status",   "clock_probe", "clock_answer"};
  int haptic_threads = 2 + testing::kSanitizerThreads;  ///< the loop, and what writes to the network

  explicit Needs(const Scene& scene) {
    const auto any = [&](auto&& has) { return std::ranges::any_of(scene.bodies, has); };
    const bool moving = any([](const Body& b) { return as<MovingSpec>(b) != nullptr; });
    const bool shell = any([](const Body& b) { return as<ShellSpec>(b) != nullptr; });
    const auto relaxes = [](const QuasiStaticSpec* body) { return body && body->relaxation; };
    const bool relaxing = any([&](const Body& b) { return relaxes(as<QuasiStaticSpec>(b)); });
    const bool catheter = any([](const Body& b) { return as<CatheterSpec>(b) != nullptr; });
    const auto by_bus = [](const Tool& t) { return std::holds_alternative<BusDeviceSpec>(t.device); };
    const bool on_bus = std::ranges::any_of(scene.tools, by_bus);
    const auto add = [](Names& to, Names names) { to.merge(names); };
    if (scene.render) add(programs, {"render_node"}), add(topics, {"picture_state"});
    if (moving) add(programs, {"deform_node"});
    if (scene.record) add(programs, {"palpate"});
    if (scene.render || moving) add(topics, {"held_contacts"});
    if (moving)
      add(topics, {"surface_state", "surface_state/all", "topology_change", "held_topology", "local_contact_model",
                   "deform_step", "deform_keyframe"});
    if (shell) add(topics, {"modal_state"});
    if (relaxing) add(topics, {"creep_state"});
    if (catheter) add(topics, {"catheter_state", "task_record"});
    if (on_bus) add(topics, {"device_state"});
    haptic_threads += moving || on_bus;
  }
};

/// An example scene, its pictures small: what is drawn is judged elsewhere.
Scene example(const std::string& name) {
  Scene scene = load_scene(fs::path(PALPATE_SOURCE) / "scenes" / (name + ".toml"));
  if (scene.render) scene.render->width = 160, scene.render->height = 120;
  return scene;
}

class SceneNeeds : public ::testing::TestWithParam<std::string> {};

TEST_P(SceneNeeds, WhatRunsIsWhatItsSectionsAskFor) {
  const Scene scene = example(GetParam());
  const Needs needs(scene);
  const testing::OwnFolder folder("needs");
  const std::string file = folder / "scene.toml";
  std::ofstream(file) << to_toml(scene);
  const int domain = testing::own_domain();
  const auto made = testing::run_program(program("palpate") + " precompute " + file);
  ASSERT_EQ(made.status, 0) << made.err;

  std::vector<std::string> command{program("palpate"),
                                   "run",
                                   file,
                                   "--seconds",
                                   "10",
                                   "--processes",
                                   "2",
                                   "--domain",
                                   std::to_string(domain),
                                   "--summary",
                                   folder / "summary.json"};
  const fs::path keys = scene.network.security ? folder / "keys" : "";
  if (!keys.empty()) {
    ASSERT_EQ(testing::run_program(program("palpate") + " keys " + keys.string()).status, 0);
    command.insert(command.end(), {"--keys", keys});
  }
  TopicSpy spy(domain, keys);
  ChildProcess run("palpate", command);
  Names programs, topics, files;
  int threads = 0;
  // Until all is there, and for a while after it: for what is not asked for.
  auto limit = std::chrono::steady_clock::now() + 60s;
  bool whole = false;
  while (run.running() && std::chrono::steady_clock::now() < limit) {
    std::this_thread::sleep_for(20ms);
    topics = spy.look();
    for (const auto& [name, pid] : children_of(run.pid())) {
      programs.insert(name);
      if (name != "haptic_node" || !topics.contains("haptic_keyframe")) continue;  // still reading
      threads = std::max(threads, own_threads(pid, name));
      files.merge(open_files(pid));
    }
    run.take_lines();
    const bool all = programs == needs.programs && topics == needs.topics && threads == needs.haptic_threads;
    if (!std::exchange(whole, whole || all) && whole) limit = std::chrono::steady_clock::now() + 500ms;
  }
  run.interrupt();
  ASSERT_TRUE(run.wait(20s));
  ASSERT_EQ(run.status(), 0);
  EXPECT_EQ(programs, needs.programs);
  EXPECT_EQ(topics, needs.topics);
  EXPECT_EQ(threads, needs.haptic_threads);
  EXPECT_EQ(files, Names{}) << "all is read before the loop runs";

  const auto summary = nlohmann::json::parse(text_of(folder / "summary.json"));
  for (const std::string& name : needs.programs) {
    const std::string node = name == "palpate" ? "recorder" : name;
    EXPECT_GT(summary[node]["startup_s"].get<double>(), 0) << node;
    EXPECT_GT(summary[node]["resident_bytes"].get<double>(), 1e6) << node;
  }
}

TEST(SceneNeedsNobody, ARunThatNobodyLooksAtDrawsNothingAndSaysHowToLook) {
  for (const auto& [name, programs] :
       {std::pair<std::string, Names>{"plate", {"haptic_node"}}, {"plate_cut", {"haptic_node", "deform_node"}}}) {
    const testing::OwnFolder folder("nobody");
    const std::string scene = PALPATE_SOURCE "/scenes/" + name + ".toml", summary = folder / "summary.json";
    const auto run = testing::run_program(fmt::format("{} run {} --seconds 1 --domain {} --summary {}",
                                                      program("palpate"), scene, testing::own_domain(), summary));
    ASSERT_EQ(run.status, 0) << run.err;
    const auto said = nlohmann::json::parse(text_of(summary));
    Names started;
    for (const auto& [node, of_it] : said.items())
      if (of_it.is_object()) started.insert(node);
    EXPECT_EQ(started, programs) << name;
    EXPECT_NE(run.out.find("nothing was shown: --web shows it in a browser, --film"), std::string::npos) << run.out;
  }
}

std::vector<std::string> example_scenes() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(fs::path(PALPATE_SOURCE) / "scenes"))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem());
  std::ranges::sort(names);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Example, SceneNeeds, ::testing::ValuesIn(example_scenes()),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace palpate
