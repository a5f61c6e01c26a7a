/// An observer: hears all samples of every topic, writes nothing, and prints at the end how many came and how many are
/// missing by their sequence numbers, as JSON. listener [--domain N] [--interface NAME] [--peer HOST]
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>
#include <tuple>

#include "common/bus/dds_bus.hpp"
#include "common/bus/sequence.hpp"
#include "common/realtime/shutdown.hpp"

namespace palpate {
namespace {

template <class M>
struct Ear {
  Topic<M> topic;
  std::unique_ptr<Reader<M>> reader;
  SequenceCheck sequence{};
  std::uint64_t samples = 0;

  void listen() {
    while (const auto message = reader->take()) {
      sequence.add(*message);
      ++samples;
    }
  }
};

template <class... M>
auto make_ears(Bus& bus, const std::tuple<Topic<M>...>& all) {
  return std::apply(
      [&](const auto&... topic) {
        return std::tuple{Ear<M>{topic, bus.reader(topic, Keep::all)}...};
      },
      all);
}

void run(const BusSettings& settings) {
  const auto bus = make_dds_bus(settings);
  auto ears = make_ears(*bus, topics::all);
  const auto each = [&](const auto& f) { std::apply([&](auto&... ear) { (f(ear), ...); }, ears); };
  fmt::print("ready\n");
  std::fflush(stdout);
  while (!shutdown_requested()) {
    bus->wait(std::chrono::milliseconds(50));
    each([](auto& ear) { ear.listen(); });
  }
  each([](auto& ear) { ear.listen(); });  // what came while it was told to end
  std::uint64_t messages = 0, missing = 0;
  nlohmann::json of_topics = nlohmann::json::object();
  each([&](const auto& ear) {
    messages += ear.samples;
    missing += ear.sequence.missing();
    if (ear.samples > 0) of_topics[ear.topic.name] = {{"samples", ear.samples}, {"missing", ear.sequence.missing()}};
  });
  fmt::print(
      "{}\n",
      nlohmann::json{{"node", "listener"}, {"messages", messages}, {"missing", missing}, {"topics", of_topics}}.dump());
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::catch_shutdown_signals();
  palpate::BusSettings settings;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view key = argv[i];
    if (key == "--domain") settings.domain = std::stoi(argv[i + 1]);
    if (key == "--interface") settings.interface = argv[i + 1];
    if (key == "--peer") settings.peers.emplace_back(argv[i + 1]);
  }
  palpate::run(settings);
}
