#include "tools/log_player.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "common/bus/log_reader.hpp"
#include "common/realtime/clock.hpp"

namespace palpate {
namespace {

constexpr std::int64_t kSpinNs = 100'000;
constexpr std::int64_t kProgressNs = 250'000'000;
constexpr std::int64_t kLongestSilence = 3600 * kNsPerS;

constexpr double kLongestPlay = 1e18;  // [ns]

/// The time in a log since its first event. Times more than an hour apart are not true: between them none passes.
class LogTime {
 public:
  explicit LogTime(std::int64_t first_ns) : last_(first_ns) {}

  std::int64_t since_start(std::int64_t receive_ns) {
    const std::int64_t passed = receive_ns - std::exchange(last_, receive_ns);
    const bool silence = std::abs(passed) > kLongestSilence;
    leaps_ += silence;
    if (!silence) since_start_ += passed;
    return std::max<std::int64_t>(since_start_, 0);
  }
  std::uint64_t leaps() const { return leaps_; }

 private:
  std::int64_t last_, since_start_ = 0;
  std::uint64_t leaps_ = 0;
};

template <class M>
struct Outlet {
  Topic<M> topic;
  std::unique_ptr<Writer<M>> writer;  ///< empty if the topic is not played
};

template <class... M>
auto make_outlets(Bus& bus, const std::tuple<Topic<M>...>& all, const std::set<std::string>& wanted) {
  return std::apply(
      [&](const auto&... topic) {
        return std::tuple{Outlet<M>{topic, wanted.contains(topic.name) ? bus.writer(topic) : nullptr}...};
      },
      all);
}
using Outlets = decltype(make_outlets(std::declval<Bus&>(), topics::all, {}));

/// Which of the wanted topics the log holds.
std::set<std::string> topics_in(const std::filesystem::path& file, const std::vector<std::string>& wanted) {
  std::set<std::string> known, found;
  topics::for_each([&](const auto& topic) { known.insert(topic.name); });
  for (const std::string& name : wanted)
    if (!known.contains(name)) throw std::runtime_error(fmt::format("there is no topic '{}'", name));
  LogReader reader(file);
  LogEvent event;
  while (reader.next(event)) {
    const bool chosen = wanted.empty() || std::find(wanted.begin(), wanted.end(), event.channel) != wanted.end();
    if (chosen && known.contains(event.channel)) found.insert(event.channel);
  }
  return found;
}

/// Moves the times inside a message that say when something happened.
template <class M>
void shift_times(M& message, std::int64_t by) {
  const auto shift = [by](std::int64_t& time) { time = time > 0 ? time + by : time; };
  if constexpr (requires { message.sense_ns; }) shift(message.sense_ns);
  if constexpr (requires { message.publish_ns; }) shift(message.publish_ns);
  if constexpr (requires { message.stamp_ns; }) shift(message.stamp_ns);
}

class Player {
 public:
  Player(Bus& bus, const std::set<std::string>& names) : outlets_(make_outlets(bus, topics::all, names)) {}

  /// Gives discovery a moment; without readers it plays all the same.
  void wait_for_readers(std::chrono::nanoseconds patience) const {
    const auto heard = [](const auto&... o) { return ((!o.writer || o.writer->readers() > 0) && ...); };
    const std::int64_t end = now_ns() + patience.count();
    while (now_ns() < end && !std::apply(heard, outlets_)) sleep_until_ns(now_ns() + 10'000'000);
  }

  bool send(const LogEvent& event, std::int64_t now) {
    bool sent = false;
    std::apply([&](auto&... outlet) { ((sent = sent || send_to(outlet, event, now)), ...); }, outlets_);
    return sent;
  }

 private:
  template <class M>
  static bool send_to(Outlet<M>& outlet, const LogEvent& event, std::int64_t now) {
    M message;
    if (!outlet.writer || !event.read(outlet.topic, message)) return false;
    shift_times(message, now - event.receive_ns);
    return outlet.writer->write(message);
  }

  Outlets outlets_;
};

void wait_until(std::int64_t time) {
  while (time - now_ns() > kSpinNs) sleep_until_ns(std::min(time - kSpinNs, now_ns() + kProgressNs));
  while (now_ns() < time) {
  }
}

}  // namespace

PlayReport play_log(const std::filesystem::path& file, Bus& bus, const PlaySettings& settings,
                    const std::function<bool(double)>& progress) {
  if (!(settings.speed > 0)) throw std::runtime_error("the speed of a replay must be positive");
  Player player(bus, topics_in(file, settings.topics));
  player.wait_for_readers(settings.patience);

  PlayReport report;
  LogReader reader(file);
  LogEvent event;
  std::optional<LogTime> time;
  std::int64_t start = 0, next_progress = 0;
  bool go_on = true;
  while (go_on && (report.complete = !reader.next(event), !report.complete)) {
    if (!time) start = now_ns(), time.emplace(event.receive_ns);
    const std::int64_t in_log = time->since_start(event.receive_ns);
    const double after = std::min(static_cast<double>(in_log) / settings.speed, kLongestPlay);
    const std::int64_t due = start + static_cast<std::int64_t>(after);
    while (go_on && due - now_ns() > kProgressNs) {  // a long silence in the log must not delay Ctrl-C
      sleep_until_ns(now_ns() + kProgressNs);
      go_on = progress(report.seconds);
    }
    if (!go_on) break;
    wait_until(due);
    const std::int64_t now = now_ns();
    ++(player.send(event, now) ? report.played : report.skipped);
    report.pace.record(now_ns() - due);
    report.seconds = 1e-9 * static_cast<double>(in_log);
    if (now < next_progress) continue;
    next_progress = now + kProgressNs;
    go_on = progress(report.seconds);
  }
  report.damage = reader.damage_text();
  if (time) report.leaps = time->leaps();
  return report;
}

}  // namespace palpate
