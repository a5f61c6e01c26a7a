#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/realtime/clock.hpp"
#include "common/realtime/shutdown.hpp"
#include "tools/shared/commands.hpp"
#include "tools/shared/network_options.hpp"
#include "tools/top_board.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;

struct TopOptions {
  SystemNetwork network;
  double interval = 1;
  bool once = false, json = false;
};

nlohmann::ordered_json look_json(const TopOptions& o, const TopBoard& board, double seconds) {
  nlohmann::ordered_json json{{"domain", o.network.domain}};
  json.update(board.json(seconds));
  return json;
}

void run(const TopOptions& o) {
  catch_shutdown_signals();
  const auto bus = make_dds_bus(o.network);
  TopBoard board(*bus);
  const bool terminal = isatty(STDOUT_FILENO) && !o.once && !o.json;
  std::int64_t last = now_ns();
  const auto interval = static_cast<std::int64_t>(1e9 * o.interval);
  while (!shutdown_requested()) {
    bus->wait(20ms);
    board.take();
    const std::int64_t now = now_ns();
    if (now - last < interval) continue;
    const double seconds = 1e-9 * static_cast<double>(now - last);
    if (o.json)
      fmt::print("{}\n", look_json(o, board, seconds).dump());
    else
      fmt::print("{}domain {}   Ctrl-C ends\n\n{}", terminal ? "\x1b[H\x1b[2J" : "", o.network.domain,
                 board.text(seconds));
    board.begin_anew();
    last = now;
    if (std::fflush(stdout) != 0 || o.once) break;  // nobody reads it any more
  }
}

}  // namespace

void add_top_command(cli::Command& app) {
  auto o = std::make_shared<TopOptions>();
  cli::Command command =
      app.add_command("top", "Watch a running system: nodes, rates, missed ticks, latencies, forces, links");
  command.add_option("--interval", o->interval, "Time between two looks [s]").between(0.1, 60.0).show_default();
  command.add_flag("--once", o->once, "One look, then end");
  command.add_flag("--json", o->json, "Print one line of JSON a look");
  add_system_options(command, o->network, "observer");
  command.examples(
      {"palpate top", "palpate top --once --domain 3", "palpate top --json --scene scenes/two_hosts.toml"});
  command.does([o, command] {
    take_scene(command, o->network);
    run(*o);
  });
}

}  // namespace palpate
