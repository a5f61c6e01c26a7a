#include "tools/run_nodes.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <thread>

#include "common/realtime/shutdown.hpp"

namespace palpate {

using namespace std::chrono_literals;

namespace {
constexpr std::chrono::seconds kPatience = 30s;  // with a node that has been told to stop
}  // namespace

void RunNodes::start(const std::string& role, const std::vector<std::string>& arguments) {
  nodes_.push_back({ChildProcess(role, arguments), Clock::now()});
}

void RunNodes::read() {
  std::FILE* const to = results_alone_ ? stderr : stdout;
  for (Node& n : nodes_) {
    n.process.running();
    for (const std::string& line : n.process.take_lines()) {
      if (line == "ready")
        note_ready(n);
      else if (line.starts_with('{'))
        n.summary = nlohmann::json::parse(line, nullptr, false);
      else
        fmt::print(to, "{}\n", line), std::fflush(to);
    }
  }
}

std::string RunNodes::failure() {
  for (Node& n : nodes_) {
    if (n.hung) return fmt::format("{} did not stop within {} s and was killed", n.process.name(), kPatience.count());
    const int status = n.process.running() ? 0 : n.process.status();
    if (status == 0 || stopped_early(n)) continue;
    const int signal = status - 128;
    return signal > 0 ? fmt::format("{} was killed by signal {} ({})", n.process.name(), signal, strsignal(signal))
                      : fmt::format("{} stopped with status {}; its message stands above", n.process.name(), status);
  }
  return {};
}

void RunNodes::check() {
  if (const std::string said = failure(); !said.empty()) throw std::runtime_error(said);
}

void RunNodes::wait_ready() {
  const auto limit = Clock::now() + 60s;
  for (bool all = false; !all && !shutdown_requested();) {
    read();
    check();
    all = true;
    for (const Node& n : nodes_) all &= n.ready;
    if (Clock::now() > limit) throw std::runtime_error("a node did not become ready within a minute");
    std::this_thread::sleep_for(10ms);
  }
}

void RunNodes::stop() {
  const auto told_last = [](const Node& n) { return n.process.name() == kRecorder; };
  if (!nodes_.empty()) end(nodes_.back());
  for (Node& n : nodes_)
    if (!told_last(n)) n.process.interrupt();
  for (Node& n : nodes_)
    if (!told_last(n)) await(n);
  for (Node& n : nodes_)
    if (told_last(n)) end(n);
  read();
}

nlohmann::json RunNodes::summary() const {
  nlohmann::json all;
  for (const Node& n : nodes_) {
    nlohmann::json& node = all[n.process.name()] = n.summary;
    if (!node.is_object()) continue;
    node["startup_s"] = n.startup;
    node["resident_bytes"] = n.resident;
  }
  return all;
}

void RunNodes::await(Node& node) {
  node.hung = !node.process.wait(kPatience);
  if (node.hung) node.process.kill();
}

void RunNodes::end(Node& node) {
  node.process.interrupt();
  await(node);
}

// Stopped by this process before it could take notice.
bool RunNodes::stopped_early(const Node& node) {
  return shutdown_requested() && !node.ready && node.process.status() == 128 + SIGINT;
}

void RunNodes::note_ready(Node& node) {
  node.ready = true;
  node.startup = std::chrono::duration<double>(Clock::now() - node.begun).count();
  std::ifstream statm(fmt::format("/proc/{}/statm", node.process.pid()));
  double pages = 0, resident = 0;
  if (statm >> pages >> resident) node.resident = resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace palpate
