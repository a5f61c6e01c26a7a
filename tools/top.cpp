#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <memory>

#include "common/bus/sequence.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/shutdown.hpp"
#include "tools/commands.hpp"
#include "tools/latency/hop_times.hpp"
#include "tools/network_options.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;

struct TopOptions {
  BusSettings network;
  double interval = 1;
  bool once = false;
};

/// What has been heard of one node.
struct Known {
  NodeStatus status;
  std::int64_t heard_ns = 0;
};

/// What has been heard of one tool since the last look.
struct Hand {
  ForceState last;
  double strongest = 0;  ///< [N]
  std::uint64_t steps = 0;
};

/// A running system as seen from here.
class Board {
 public:
  explicit Board(Bus& bus)
      : nodes_(bus.reader(topics::node_status)),
        forces_(bus.reader(topics::force_state, Keep::all)),
        surfaces_(bus.reader(topics::surface_state)),
        pictures_(bus.reader(topics::picture_state, Keep::all)) {}

  void take() {
    const std::int64_t now = now_ns();
    while (const auto m = nodes_->take()) {
      hops_.add(*m);
      known_[m->node] = {*m, now};
    }
    while (const auto m = forces_->take()) {
      hops_.add(*m);
      sequence_.add(*m);
      Hand& hand = hands_[m->tool];
      hand.last = *m;
      hand.strongest = std::max(hand.strongest, std::hypot(m->force[0], m->force[1], m->force[2]));
      ++hand.steps;
      last_force_ns_ = now;
    }
    while (const auto m = surfaces_->take()) hops_.add(*m);
    while (const auto m = pictures_->take()) hops_.add(*m);
  }

  /// The board as text; what is counted begins anew.
  std::string look(double seconds) {
    std::string text = nodes_text() + hands_text(seconds) + hops_text();
    hops_.clear_times();
    for (auto& [tool, hand] : hands_) hand.strongest = 0, hand.steps = 0;
    return text;
  }

 private:
  /// Nodes announce themselves once a second.
  static std::string link(double silent_s) {
    if (silent_s < 2) return "up";
    return silent_s < 5 ? fmt::format("silent {:.0f} s", silent_s) : fmt::format("lost {:.0f} s ago", silent_s);
  }

  static std::string clock(const NodeStatus& s) {
    if (s.clock_of.empty()) return s.role == "haptic" ? "the reference" : "-";
    if (s.clock_uncertainty_ns == 0) return "the same";
    return fmt::format("{:+.3f} ± {:.3f} ms, {:+.1f} ppm", 1e-6 * static_cast<double>(s.clock_offset_ns),
                       1e-6 * static_cast<double>(s.clock_uncertainty_ns), s.clock_drift_ppm);
  }

  std::string nodes_text() const {
    if (known_.empty()) return "no node is heard of\n";
    std::string text = fmt::format("{:28} {:14} {:>9} {:>12} {:>9} {:>11} {:>11}  {}\n", "node", "link", "rate Hz",
                                   "ticks", "missed", "p50 us", "p99 us", "clock");
    for (const auto& [name, k] : known_) {
      const NodeStatus& s = k.status;
      text += fmt::format("{:28} {:14} {:9.1f} {:12} {:9} {:11.1f} {:11.1f}  {}\n", name,
                          link(1e-9 * static_cast<double>(now_ns() - k.heard_ns)), s.rate_hz, s.ticks, s.missed,
                          s.latency_p50_us, s.latency_p99_us, clock(s));
      if (!s.text.empty()) text += fmt::format("  {}\n", s.text);
    }
    return text;
  }

  std::string hands_text(double seconds) const {
    std::string text;
    for (const auto& [tool, hand] : hands_) {
      const auto& f = hand.last.force;
      text += fmt::format("tool {}   force {:6.3f} N now, {:6.3f} N at most   {:7.1f} steps a second{}{}\n", tool,
                          std::hypot(f[0], f[1], f[2]), hand.strongest, static_cast<double>(hand.steps) / seconds,
                          hand.last.flags & fault ? "   fault: force off" : "",
                          hand.last.flags & (force_limited | slew_limited | passivity_limited) ? "   limited" : "");
    }
    if (sequence_.missing() > 0) text += fmt::format("{} forces never came here\n", sequence_.missing());
    if (!hands_.empty() && now_ns() - last_force_ns_ > kNsPerS)
      text += fmt::format("no force for {:.1f} s\n", 1e-9 * static_cast<double>(now_ns() - last_force_ns_));
    return text.empty() ? text : "\n" + text;
  }

  std::string hops_text() const {
    std::string text;
    const auto row = [&](const char* name, const Histogram& h) {
      if (h.count() == 0) return;
      const Percentiles p = percentiles_us(h);
      text += fmt::format("{:16} {:10.1f} {:10.1f} {:10.1f}\n", name, p.p50, p.p99, p.max);
    };
    row("tool to force", hops_.force());
    row("tool to surface", hops_.surface());
    row("tool to picture", hops_.picture());
    return text.empty() ? text
                        : fmt::format("\n{:16} {:>10} {:>10} {:>10}\n", "one way [us]", "p50", "p99", "max") + text;
  }

  std::unique_ptr<Reader<NodeStatus>> nodes_;
  std::unique_ptr<Reader<ForceState>> forces_;
  std::unique_ptr<Reader<SurfaceState>> surfaces_;
  std::unique_ptr<Reader<PictureState>> pictures_;
  std::map<std::string, Known> known_;
  std::map<std::uint32_t, Hand> hands_;
  SequenceCheck sequence_;
  HopTimes hops_;
  std::int64_t last_force_ns_ = 0;
};

void run(const TopOptions& o) {
  catch_shutdown_signals();
  const auto bus = make_dds_bus(o.network);
  Board board(*bus);
  const bool terminal = isatty(STDOUT_FILENO) && !o.once;
  std::int64_t last = now_ns();
  const auto interval = static_cast<std::int64_t>(1e9 * o.interval);
  while (!shutdown_requested()) {
    bus->wait(20ms);
    board.take();
    const std::int64_t now = now_ns();
    if (now - last < interval) continue;
    fmt::print("{}domain {}   Ctrl-C ends\n\n{}", terminal ? "\x1b[H\x1b[2J" : "", o.network.domain,
               board.look(1e-9 * static_cast<double>(now - last)));
    std::fflush(stdout);
    last = now;
    if (o.once) break;
  }
}

}  // namespace

void add_top_command(cli::Command& app) {
  auto o = std::make_shared<TopOptions>();
  cli::Command command =
      app.add_command("top", "Watch a running system: nodes, rates, missed ticks, latencies, forces, links");
  command.add_option("--interval", o->interval, "Time between two looks [s]").between(0.1, 60.0).show_default();
  command.add_flag("--once", o->once, "One look, then end");
  add_network_options(command, o->network, "observer");
  command.examples({"palpate top", "palpate top --once --domain 3"});
  command.does([o] { run(*o); });
}

}  // namespace palpate
