#include "tools/log_player.hpp"

#include <algorithm>
#include <stdexcept>

#include "common/realtime/clock.hpp"
#include "tools/logs/log_sender.hpp"
#include "tools/logs/log_time.hpp"

namespace palpate {
namespace {

constexpr std::int64_t kSpinNs = 100'000;
constexpr std::int64_t kProgressNs = 250'000'000;
constexpr double kLongestPlay = 1e18;  // [ns]

void wait_until(std::int64_t time) {
  while (time - now_ns() > kSpinNs) sleep_until_ns(std::min(time - kSpinNs, now_ns() + kProgressNs));
  while (now_ns() < time) {
  }
}

}  // namespace

PlayReport play_log(const std::filesystem::path& file, Bus& bus, const PlaySettings& settings,
                    const std::function<bool(double)>& progress) {
  if (!(settings.speed > 0)) throw std::runtime_error("the speed of a replay must be positive");
  LogSender player(bus, topics_in(file, settings.topics));
  player.wait_for_readers(settings.patience);  // without readers it plays all the same

  PlayReport report;
  LogReader reader(file);
  LogEvent event;
  LogTime time;
  std::int64_t start = 0, next_progress = 0;
  bool go_on = true;
  while (go_on && (report.complete = !reader.next(event), !report.complete)) {
    if (start == 0) start = now_ns();
    const std::int64_t in_log = time.since_start(event.receive_ns);
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
  report.leaps = time.leaps();
  return report;
}

}  // namespace palpate
