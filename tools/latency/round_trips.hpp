#pragma once
#include <atomic>
#include <thread>
#include <vector>

#include "common/realtime/histogram.hpp"
#include "tools/latency/echo.hpp"

namespace palpate::latency {

/// What has become of the messages sent over one way.
struct RoundTripReport {
  std::uint64_t sent = 0, lost = 0, reordered = 0, repeated = 0;
  Histogram time;        ///< [ns] there and back
  double jitter_ns = 0;  ///< mean change from one round trip to the next
};

/// Sends over one way and takes what comes back on another thread, so that many may be under way at once: one of its
/// own, or the middleware's where the way has it so.
class RoundTrips {
 public:
  explicit RoundTrips(std::unique_ptr<Echo> echo);
  ~RoundTrips();

  void send();                 ///< one more
  std::uint64_t back() const;  ///< how many have come back so far
  /// Forgets what was measured so far: what is under way does not count.
  void begin();
  /// Waits for what is under way, a second at most, and says what was measured since begin().
  RoundTripReport finish();

 private:
  static constexpr std::size_t kUnderWay = 1 << 16;
  void receive(const std::stop_token& stop);
  void came(std::uint64_t seq);
  void stop();

  std::unique_ptr<Echo> echo_;
  std::vector<std::atomic<std::int64_t>> sent_ns_;  ///< by number; 0: came back
  std::atomic<std::uint64_t> next_{1}, first_{1}, back_{0};
  RoundTripReport report_;  ///< of the receiving thread until it ends
  std::uint64_t from_ = 1;  ///< first number in it
  std::int64_t last_ns_ = 0;
  std::uint64_t highest_ = 0, changes_ = 0;
  std::jthread thread_;
};

}  // namespace palpate::latency
