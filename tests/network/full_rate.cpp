/// Writes every topic, for a recorder to keep up with: full_rate HZ SECONDS READERS DOMAIN [INTERFACE [PEER]]. It
/// waits until every topic has so many readers, and at the end until all is delivered; then it prints what it wrote, as
/// JSON.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <tuple>

#include "common/bus/codec.hpp"
#include "common/bus/dds_bus.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/periodic.hpp"
#include "common/realtime/settings.hpp"
#include "common/realtime/shutdown.hpp"
#include "tests/network/realistic_messages.hpp"

namespace palpate::testing {
namespace {

constexpr std::int64_t kPatienceNs = 20 * kNsPerS;

template <class M>
struct Stream {
  Topic<M> topic;
  std::unique_ptr<Writer<M>> writer;
  M message;
  std::uint64_t written = 0;

  void write(std::uint64_t seq) {
    message.seq = seq;
    if constexpr (requires { message.step; }) message.step = seq;
    if constexpr (requires { message.sense_ns; }) message.sense_ns = now_ns();
    if constexpr (requires { message.publish_ns; }) message.publish_ns = 0;
    written += writer->write(message);
  }
};

template <class... M>
auto make_streams(Bus& bus, const std::tuple<Topic<M>...>& all) {
  return std::apply(
      [&](const auto&... topic) {
        return std::tuple{Stream<M>{topic, bus.writer(topic), realistic<M>()}...};
      },
      all);
}

template <class Condition>
bool wait_for(const Condition& condition) {
  const std::int64_t end = now_ns() + kPatienceNs;
  while (!condition() && now_ns() < end && !shutdown_requested()) sleep_until_ns(now_ns() + 5'000'000);
  return condition();
}

int run(double rate_hz, double seconds, int readers, const BusSettings& settings) {
  const auto bus = make_dds_bus(settings);
  auto streams = make_streams(*bus, topics::all);
  const auto each = [&](const auto& f) { std::apply([&](auto&... stream) { (f(stream), ...); }, streams); };
  const auto every = [&](const auto& f) {
    return std::apply([&](auto&... stream) { return (f(stream) && ...); }, streams);
  };
  const bool heard = wait_for([&] { return every([&](const auto& s) { return s.writer->readers() >= readers; }); });

  sleep_until_ns(now_ns() + kNsPerS);  // the readers find their writers a moment later than these find them
  request_realtime({.priority = 40, .lock_memory = false});
  PeriodicTimer timer(rate_hz);
  const auto most = static_cast<std::uint64_t>(rate_hz * seconds);
  std::uint64_t seq = 0;
  // A tick that the machine skipped is made up for: the number of messages is that of the rate.
  while (heard && seq < most && !shutdown_requested())
    for (const std::uint64_t due = std::min(timer.wait(), most); seq < due;) {
      ++seq;
      each([&](auto& s) { s.write(seq); });
    }
  leave_realtime();
  const bool delivered =
      wait_for([&] { return every([](const auto& s) { return !s.topic.qos.reliable || s.writer->delivered(); }); });

  nlohmann::ordered_json out{{"heard", heard}, {"delivered", delivered}, {"skipped", timer.statistics().skipped}};
  each([&](auto& s) {
    Bytes bytes;
    encode(s.message, bytes);
    out["topics"][s.topic.name] = {{"written", s.written}, {"refused", s.writer->refused()}, {"bytes", bytes.size()}};
  });
  fmt::print("{}\n", out.dump());
  return heard && delivered ? 0 : 1;
}

}  // namespace
}  // namespace palpate::testing

int main(int argc, char** argv) {
  using namespace palpate;
  if (argc < 5 || argc > 7) return 2;
  catch_shutdown_signals();
  BusSettings settings{.domain = std::atoi(argv[4])};
  if (argc > 5) settings.interface = argv[5];
  if (argc > 6) settings.peers = {argv[6]};
  return palpate::testing::run(std::atof(argv[1]), std::atof(argv[2]), std::atoi(argv[3]), settings);
}
