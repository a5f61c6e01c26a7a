// What do observers cost the haptic node? On two hosts made of network namespaces: haptic_node on A; deform_node and 0
// to 16 observers on B, of which one draws (render_node), every fourth records, and the others check the sequence
// numbers of all that they hear (listener). With peers, where every reader is sent a copy of its own, and with
// multicast. The cases are taken in turn, in another order each round, so that a change of the machine's load meets all
// alike; rows are medians over rounds. Each host has half of the cores. Two references tell what is the machine's: all
// processes on all cores (shared); and what a bare UDP message costs its sender with so many receivers, since the hosts
// share a kernel, which delivers in the sender's time.
#include <sched.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <thread>

#include "bench/report.hpp"
#include "bench/udp_cost.hpp"
#include "common/scene/ensure_archive.hpp"
#include "tests/network/two_hosts.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::Inside;
using testing::NetworkNamespace;
using testing::TwoHosts;
namespace fs = std::filesystem;

const std::string kScene = PALPATE_SCENES "/liver.toml";
constexpr int kPublisherPriority = 60;  // of haptic_node's thread that writes to the bus

struct Case {
  int observers;
  bool multicast;
  bool shared = false;  ///< all processes on all cores
  std::string name() const {
    return fmt::format("{}_{}", shared ? "shared" : multicast ? "multicast" : "peers", observers);
  }
};

/// While it lives, this thread and the programs it starts keep to a part of the cores.
class OnCores {
 public:
  OnCores(unsigned first, unsigned end) {
    sched_getaffinity(0, sizeof before_, &before_);
    cpu_set_t some;
    CPU_ZERO(&some);
    for (unsigned core = first; core < end; ++core) CPU_SET(core, &some);
    sched_setaffinity(0, sizeof some, &some);
  }
  ~OnCores() { sched_setaffinity(0, sizeof before_, &before_); }
  OnCores(const OnCores&) = delete;

 private:
  cpu_set_t before_;
};

/// Processor time [s] that a process's threads have had so far.
struct ThreadTimes {
  double publisher = 0, middleware = 0;
};
ThreadTimes times_of(pid_t process) {
  ThreadTimes times;
  for (const auto& thread : fs::directory_iterator(fmt::format("/proc/{}/task", process))) {
    std::ifstream schedule(thread.path() / "schedstat"), stat(thread.path() / "stat");
    double ns = 0;
    std::string text, field;
    schedule >> ns;
    std::getline(stat, text);
    std::istringstream after_name(text.substr(text.rfind(')') + 1));
    constexpr int place_of_priority = 40 - 2;  // of the fields that follow the name
    for (int i = 0; i < place_of_priority; ++i) after_name >> field;
    if (field == std::to_string(kPublisherPriority))
      times.publisher += 1e-9 * ns;
    else if (thread.path().filename() != std::to_string(process))
      times.middleware += 1e-9 * ns;
  }
  return times;
}

/// Datagrams that left the process's host so far.
double sent_by_host_of(pid_t process) {
  std::ifstream devices(fmt::format("/proc/{}/net/dev", process));
  for (std::string line; std::getline(devices, line);) {
    const std::size_t colon = line.find(':');
    if (line.find(TwoHosts::device) >= colon) continue;
    std::istringstream figures(line.substr(colon + 1));
    double value = 0;
    constexpr int place_of_packets = 10;
    for (int i = 0; i < place_of_packets; ++i) figures >> value;
    return value;
  }
  return 0;
}

/// What one run of a case measured.
struct Run {
  json haptic;                                 ///< its summary
  double publisher_us = 0, middleware_us = 0;  ///< processor time per step
  double datagrams = 0;                        ///< that left the haptic node's host, per step
  double heard = 0, missing = 0;               ///< samples, of all observers that check
};

class Bench {
 public:
  Bench(bool quick)
      : seconds_(quick ? 2 : 5),
        rounds_(quick ? 1 : 5),
        counts_(quick ? std::vector<int>{0, 2, 16} : std::vector<int>{0, 1, 2, 4, 8, 16}) {
    for (const NetworkNamespace* host : {&hosts_.a(), &hosts_.b()}) {
      host->ip(fmt::format("link set {} multicast on", TwoHosts::device));
      host->ip(fmt::format("route add 224.0.0.0/4 dev {}", TwoHosts::device));
    }
    fs::create_directories(folder_);
  }
  ~Bench() { fs::remove_all(folder_); }

  void measure() {
    std::vector<Case> cases;
    for (const int n : counts_)
      for (const bool multicast : {false, true}) cases.push_back({n, multicast});
    for (const int n : shared_) cases.push_back({n, false, true});
    std::mt19937 random(1);
    for (int round = 0; round < rounds_; ++round) {
      std::ranges::shuffle(cases, random);
      for (const Case& c : cases) {
        runs_[c.name()].push_back(run(c));
        std::fprintf(stderr, "round %d, %s: step p99 %.1f us, %.0f missing\n", round + 1, c.name().c_str(),
                     runs_[c.name()].back().haptic["step_us_p99"].get<double>(), runs_[c.name()].back().missing);
      }
    }
    for (const bool multicast : {false, true})
      for (const int n : counts_) print({n, multicast});
    for (const int n : shared_) print({n, false, true});
    for (const int n : counts_)
      for (const bool multicast : {false, true}) {
        const double us =
            1e6 * bench::bare_udp_cost(hosts_.a(), hosts_.b(), n + 1, multicast);  // the deformation node listens too
        bench::report("observers", Case{n, multicast}.name(), "bare_udp", us, "us/message");
      }
  }

 private:
  ChildProcess start(const NetworkNamespace& host, const char* peer, const Case& c, const std::string& name,
                     std::vector<std::string> words) const {
    words.insert(words.begin(), sibling_program(name));
    words.insert(words.end(), {"--domain", c.multicast ? "97" : "96", "--interface", TwoHosts::device});
    if (!c.multicast) words.insert(words.end(), {"--peer", peer});
    const Inside here(host);
    const unsigned cores = std::thread::hardware_concurrency(), half = std::max(1u, cores / 2);
    const bool on_a = &host == &hosts_.a() && cores > 1, on_b = &host == &hosts_.b() && cores > 1;
    const OnCores own(on_b && !c.shared ? half : 0, on_a && !c.shared ? half : cores);
    return ChildProcess(name, words);
  }
  ChildProcess on_b(const Case& c, const std::string& name, const std::vector<std::string>& words) const {
    return start(hosts_.b(), TwoHosts::address_a, c, name, words);
  }
  ChildProcess observer(const Case& c, int i) const {
    if (i == 0) return on_b(c, "render_node", {kScene, "--supervised"});
    if (i % 4 == 1)
      return on_b(c, "palpate", {"record", "--supervised", "-o", (folder_ / fmt::format("{}.lcmlog", i)).string()});
    return on_b(c, "listener", {});
  }
  static void await_ready(ChildProcess& process) {
    while (process.take_lines().empty()) {
      if (!process.running())
        throw std::runtime_error(fmt::format("{} ended with status {}", process.name(), process.status()));
      std::this_thread::sleep_for(5ms);
    }
  }

  Run run(const Case& c) const {
    std::vector<ChildProcess> others;
    others.push_back(on_b(c, "deform_node", {kScene, "--supervised"}));
    for (int i = 0; i < c.observers; ++i) others.push_back(observer(c, i));
    for (ChildProcess& process : others) await_ready(process);
    std::this_thread::sleep_for(1s);
    ChildProcess haptic = start(hosts_.a(), TwoHosts::address_b, c, "haptic_node",
                                {kScene, "--supervised", "--seconds", fmt::format("{}", seconds_ + 2)});
    await_ready(haptic);
    std::this_thread::sleep_for(1500ms);  // the peers have met, and the loop runs
    const auto begin = std::chrono::steady_clock::now();
    const ThreadTimes before = times_of(haptic.pid());
    const double sent_before = sent_by_host_of(haptic.pid());
    std::this_thread::sleep_for(std::chrono::milliseconds(static_cast<int>(1000 * seconds_)));
    const ThreadTimes after = times_of(haptic.pid());
    const double sent = sent_by_host_of(haptic.pid()) - sent_before;
    const double taken = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (!haptic.wait(20s)) throw std::runtime_error("haptic_node does not end");
    Run r{.haptic = json::parse(haptic.take_lines().back())};
    const double steps = taken * r.haptic["rate_hz"].get<double>();
    r.publisher_us = 1e6 * (after.publisher - before.publisher) / steps;
    r.middleware_us = 1e6 * (after.middleware - before.middleware) / steps;
    r.datagrams = sent / steps;
    for (ChildProcess& process : others) process.interrupt();
    for (ChildProcess& process : others) {
      if (!process.wait(20s)) throw std::runtime_error(process.name() + " does not end");
      const auto lines = process.take_lines();
      const json said = lines.empty() ? json::object() : json::parse(lines.back());
      r.heard += said.value("messages", 0.0);
      const double missing = said.value("missing", 0.0) + said.value("lost", 0.0);
      if (missing > 0) std::fprintf(stderr, "%s: %s\n", c.name().c_str(), said.dump().c_str());
      r.missing += missing;
    }
    return r;
  }

  void print(const Case& c) const {
    const std::vector<Run>& of = runs_.at(c.name());
    const auto row = [&](const char* metric, const auto& value, const char* unit) {
      bench::Samples samples;
      for (const Run& r : of) samples.add(value(r));
      bench::report("observers", c.name(), metric, samples.median(), unit);
    };
    const auto of_haptic = [](const char* key) {
      return [key](const Run& r) { return r.haptic.at(key).template get<double>(); };
    };
    for (const char* share : {"p50", "p99", "p999"})
      row(fmt::format("step_{}", share).c_str(), of_haptic(fmt::format("step_us_{}", share).c_str()), "us");
    row("late_p99", of_haptic("late_us_p99"), "us");
    row("missed", of_haptic("missed"), "steps");
    row("rate", of_haptic("rate_hz"), "Hz");
    row("ring_to_wire_p50", of_haptic("ring_to_wire_us_p50"), "us");
    row("ring_to_wire_p99", of_haptic("ring_to_wire_us_p99"), "us");
    row(
        "publisher", [](const Run& r) { return r.publisher_us; }, "us/step");
    row(
        "middleware", [](const Run& r) { return r.middleware_us; }, "us/step");
    row(
        "datagrams", [](const Run& r) { return r.datagrams; }, "1/step");
    row(
        "heard", [](const Run& r) { return r.heard; }, "samples");
    double missing = 0;
    for (const Run& r : of) missing += r.missing;
    bench::report("observers", c.name(), "missing", missing, "samples");
  }

  double seconds_;
  int rounds_;
  std::vector<int> counts_, shared_{0, 16};
  TwoHosts hosts_{TwoHosts::Link::veth};
  fs::path folder_ = fs::temp_directory_path() / fmt::format("palpate-observers-{}", getpid());
  std::map<std::string, std::vector<Run>> runs_;
};

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  try {
    const palpate::TwoHosts permitted(palpate::TwoHosts::Link::veth);
  } catch (const std::exception& reason) {
    fmt::print(stderr, "bench_observers: left out, as {}\n", reason.what());
    return 0;
  }
  try {
    for (const palpate::Body& body : palpate::load_scene(palpate::kScene).bodies)
      palpate::ensure_archive(palpate::load_scene(palpate::kScene), body);
    palpate::Bench(palpate::bench::quick(argc, argv)).measure();
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_observers: {}\n", error.what());
    return 1;
  }
}
