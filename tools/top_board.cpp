#include "tools/top_board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/describe/printable.hpp"
#include "common/realtime/clock.hpp"
#include "tools/latency/hop_json.hpp"

namespace palpate {
namespace {

using Json = nlohmann::ordered_json;

double since_s(std::int64_t then_ns) {
  return 1e-9 * static_cast<double>(now_ns() - then_ns);
}

/// Nodes announce themselves once a second.
std::string link(double silent_s) {
  if (silent_s < 2) return "up";
  return silent_s < 5 ? fmt::format("silent {:.0f} s", silent_s) : fmt::format("lost {:.0f} s ago", silent_s);
}

std::string clock(const NodeStatus& s) {
  if (s.clock_of.empty()) return s.role == "haptic" ? "the reference" : "-";
  if (s.clock_uncertainty_ns == 0) return "the same";
  return fmt::format("{:+.3f} ± {:.3f} ms, {:+.1f} ppm", 1e-6 * static_cast<double>(s.clock_offset_ns),
                     1e-6 * static_cast<double>(s.clock_uncertainty_ns), s.clock_drift_ppm);
}

/// A latency; 0 is announced by nodes that measure none.
std::string microseconds(double us) {
  return us > 0 ? fmt::format("{:.1f}", us) : "-";
}
Json measured(double value) {
  return value > 0 ? Json(value) : Json(nullptr);
}

double length(const std::array<double, 3>& force) {
  return std::hypot(force[0], force[1], force[2]);
}

}  // namespace

TopBoard::TopBoard(Bus& bus)
    : nodes_(bus.reader(topics::node_status)),
      forces_(bus.reader(topics::force_state, Keep::all)),
      surfaces_(bus.reader(topics::surface_state)),
      pictures_(bus.reader(topics::picture_state, Keep::all)) {}

void TopBoard::take() {
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
    hand.strongest = std::max(hand.strongest, length(m->force));
    ++hand.steps;
    last_force_ns_ = now;
  }
  while (const auto m = surfaces_->take()) hops_.add(*m);
  while (const auto m = pictures_->take()) hops_.add(*m);
}

void TopBoard::begin_anew() {
  hops_.clear_times();
  for (auto& [tool, hand] : hands_) hand.strongest = 0, hand.steps = 0;
}

std::string TopBoard::text(double seconds) const {
  return nodes_text() + hands_text(seconds) + hops_text();
}

std::string TopBoard::nodes_text() const {
  if (known_.empty()) return "no node is heard of\n";
  std::string text = fmt::format("{:28} {:14} {:>9} {:>12} {:>9} {:>11} {:>11}  {}\n", "node", "link", "rate Hz",
                                 "ticks", "missed", "p50 us", "p99 us", "clock");
  for (const auto& [name, k] : known_) {
    const NodeStatus& s = k.status;
    text += fmt::format("{:28} {:14} {:9.1f} {:12} {:9} {:>11} {:>11}  {}\n", printable(name),
                        link(since_s(k.heard_ns)), s.rate_hz, s.ticks, s.missed, microseconds(s.latency_p50_us),
                        microseconds(s.latency_p99_us), clock(s));
    if (!s.text.empty()) text += fmt::format("  {}\n", printable(s.text));
  }
  return text;
}

std::string TopBoard::hands_text(double seconds) const {
  std::string text;
  for (const auto& [tool, hand] : hands_)
    text += fmt::format("tool {}   force {:6.3f} N now, {:6.3f} N at most   {:7.1f} steps a second{}{}\n", tool,
                        length(hand.last.force), hand.strongest, static_cast<double>(hand.steps) / seconds,
                        hand.last.flags & fault ? "   fault: force off" : "",
                        hand.last.flags & (force_limited | slew_limited | passivity_limited) ? "   limited" : "");
  if (sequence_.missing() > 0) text += fmt::format("{} forces never came here\n", sequence_.missing());
  if (!hands_.empty() && since_s(last_force_ns_) > 1)
    text += fmt::format("no force for {:.1f} s\n", since_s(last_force_ns_));
  return text.empty() ? text : "\n" + text;
}

std::string TopBoard::hops_text() const {
  std::string text;
  const auto row = [&](const char* name, const Histogram& h) {
    if (h.count() == 0) return;
    const Percentiles p = percentiles_us(h);
    text += fmt::format("{:16} {:10.1f} {:10.1f} {:10.1f}\n", name, p.p50, p.p99, p.max);
  };
  row("tool to force", hops_.force());
  row("tool to surface", hops_.surface());
  row("tool to picture", hops_.picture());
  if (!text.empty()) text = fmt::format("\n{:16} {:>10} {:>10} {:>10}\n", "one way [us]", "p50", "p99", "max") + text;
  return text + text_of(hops_.tissue());
}

Json TopBoard::json(double seconds) const {
  Json nodes = Json::array(), tools = Json::array();
  for (const auto& [name, k] : known_) {
    const NodeStatus& s = k.status;
    nodes.push_back({{"node", printable(name)},
                     {"role", printable(s.role)},
                     {"silent_s", since_s(k.heard_ns)},
                     {"rate_hz", s.rate_hz},
                     {"ticks", s.ticks},
                     {"missed", s.missed},
                     {"latency_us_p50", measured(s.latency_p50_us)},
                     {"latency_us_p99", measured(s.latency_p99_us)},
                     {"clock_offset_ns", s.clock_offset_ns},
                     {"clock_uncertainty_ns", s.clock_uncertainty_ns},
                     {"text", printable(s.text)}});
  }
  for (const auto& [tool, hand] : hands_)
    tools.push_back({{"tool", tool},
                     {"force_n", length(hand.last.force)},
                     {"force_max_n", hand.strongest},
                     {"steps_hz", static_cast<double>(hand.steps) / seconds},
                     {"flags", hand.last.flags}});
  return {{"nodes", nodes},
          {"tools", tools},
          {"missing_forces", sequence_.missing()},
          {"hops_us", json_of(hops_)},
          {"tissue_s", json_of(hops_.tissue())}};
}

}  // namespace palpate
