/// How long does a message take to another process and back on loopback? Bare Cyclone DDS through its C API,
/// beside the bus of this project, at 1 kHz. Usage: bench_latency_dds [--quick] [--there BYTES] [--back
/// BYTES]
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <string>

#include "bench/report.hpp"
#include "common/bus/bare_dds.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/periodic.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;

/// A question and its answer through the project's bus: the tool's dofs there, the force back.
class BusPort {
 public:
  explicit BusPort(int domain) : bus_(make_dds_bus({.domain = domain})) {}

  void answer_forever() {
    const auto reader = bus_->reader(topics::tool_state);
    const auto writer = bus_->writer(topics::force_state);
    ForceState force;
    for (;;) {
      bus_->wait(1s);
      while (const auto tool = reader->take()) {
        force.seq = tool->seq;
        writer->write(force);
      }
    }
  }
  void open() {
    writer_ = bus_->writer(topics::tool_state);
    reader_ = bus_->reader(topics::force_state);
  }
  void send(std::uint64_t seq) {
    ToolState tool;
    tool.seq = seq;
    writer_->write(tool);
  }
  std::uint64_t receive(std::chrono::nanoseconds timeout) {
    bus_->wait(timeout);
    const auto force = reader_->take();
    return force ? force->seq : 0;
  }

 private:
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Writer<ToolState>> writer_;
  std::unique_ptr<Reader<ForceState>> reader_;
};

/// Starts this program again as the other side and ends it with the object.
class OtherSide {
 public:
  OtherSide(const char* mode, int domain, std::size_t back) : pid_(fork()) {
    if (pid_ != 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const std::string domain_text = std::to_string(domain), back_text = std::to_string(back);
    execl("/proc/self/exe", "bench_latency_dds", mode, domain_text.c_str(), back_text.c_str(), nullptr);
    _exit(127);
  }
  ~OtherSide() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }

 private:
  pid_t pid_;
};

/// Round trips at 1 kHz once the two sides have found each other.
void ping(bench::Samples& samples, int count, const std::function<void(std::uint64_t)>& send,
          const std::function<std::uint64_t(std::chrono::nanoseconds)>& receive) {
  std::uint64_t seq = 0;
  const std::int64_t deadline = now_ns() + 10 * kNsPerS;
  for (bool found = false; !found;) {
    send(++seq);
    found = receive(20ms) == seq;
    if (now_ns() > deadline) throw std::runtime_error("the other process does not answer");
  }
  PeriodicTimer timer(1000);
  for (int i = -200; i < count; ++i) {
    timer.wait();
    const std::int64_t begin = now_ns(), limit = begin + kNsPerS;
    send(++seq);
    while (receive(100ms) != seq && now_ns() < limit) {
    }
    if (i >= 0) samples.add(1e-9 * static_cast<double>(now_ns() - begin));
  }
}

void report_all(const std::string& name, const bench::Samples& s) {
  bench::report("latency", name, "p50", 1e6 * s.median(), "us");
  bench::report("latency", name, "p99", 1e6 * s.p99(), "us");
  bench::report("latency", name, "p999", 1e6 * s.p999(), "us");
}

void measure_bare(bench::Samples& samples, int domain, int count, std::size_t there, std::size_t back) {
  OtherSide other("--answer-bare", domain, back);
  BareDds port({.domain = domain}, "bench/there", "bench/back");
  std::vector<std::uint8_t> bytes(there);
  ping(
      samples, count, [&](std::uint64_t seq) { port.send(seq, bytes); },
      [&](auto timeout) { return port.receive(timeout); });
}

void measure_bus(bench::Samples& samples, int domain, int count) {
  OtherSide other("--answer-bus", domain, 0);
  BusPort port(domain);
  port.open();
  ping(
      samples, count, [&](std::uint64_t seq) { port.send(seq); }, [&](auto timeout) { return port.receive(timeout); });
}

int answer_bare(int domain, std::size_t back) {
  BareDds port({.domain = domain}, "bench/back", "bench/there");
  std::vector<std::uint8_t> bytes(back);
  for (;;)
    if (const std::uint64_t seq = port.receive(1s)) port.send(seq, bytes);
}

std::size_t size_option(int argc, char** argv, const char* name, std::size_t otherwise) {
  for (int i = 1; i + 1 < argc; ++i)
    if (std::strcmp(argv[i], name) == 0) return std::strtoul(argv[i + 1], nullptr, 10);
  return otherwise;
}

int run(int argc, char** argv) {
  if (argc == 4 && std::strcmp(argv[1], "--answer-bare") == 0)
    return answer_bare(std::atoi(argv[2]), std::strtoul(argv[3], nullptr, 10));
  if (argc == 4 && std::strcmp(argv[1], "--answer-bus") == 0) {
    BusPort(std::atoi(argv[2])).answer_forever();
    return 0;
  }
  const int count = bench::quick(argc, argv) ? 1000 : 5000;
  const int domain = getpid() % 200;
  // One contact there, the surface of the 1,400-node liver back.
  const std::size_t there = size_option(argc, argv, "--there", 320), back = size_option(argc, argv, "--back", 20'000);
  bench::Samples sized, bare, bus;
  measure_bare(sized, 1 + domain, count, there, back);
  report_all("loopback_bare_dds", sized);

  // By turns, so that a change of the host's load meets both.
  constexpr int rounds = 4;
  for (int round = 0; round < rounds; ++round) {
    measure_bare(bare, 1 + (domain + 2 * round + 1) % 200, count / rounds, BareDds::kAsToolState,
                 BareDds::kAsForceState);
    measure_bus(bus, 1 + (domain + 2 * round + 2) % 200, count / rounds);
  }
  report_all("loopback_bare_dds_step", bare);
  report_all("loopback_bus_step", bus);
  bench::report("latency", "loopback_bus_step", "ratio_to_bare_dds", bus.median() / bare.median(), "1");
  return 0;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  try {
    return palpate::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_latency_dds: {}\n", error.what());
    return 1;
  }
}
