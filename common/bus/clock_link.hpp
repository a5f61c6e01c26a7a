#pragma once
#include <functional>
#include <memory>
#include <string>

#include "common/bus/bus.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/clock_offset.hpp"

namespace palpate {

using ClockReading = std::function<std::int64_t()>;  ///< [ns]

/// Answers the other nodes' questions for this node's clock; the haptic node has one.
class ClockServer {
 public:
  ClockServer(Bus& bus, std::string node, ClockReading clock = now_ns);
  static constexpr int kAtOnce = 8;
  void answer();  ///< what has come, a few at once, since the caller has more to do; call often

 private:
  std::unique_ptr<Reader<ClockProbe>> probes_;
  std::unique_ptr<Writer<ClockAnswer>> answers_;
  ClockAnswer answer_;
  ClockReading clock_;
};

/// Keeps the haptic node's clock in relation to this node's own. Nodes on one machine have one clock.
class ClockFollower {
 public:
  static constexpr std::int64_t kIntervalNs = 125'000'000;  ///< between two questions

  ClockFollower(Bus& bus, std::string node, ClockReading clock = now_ns);
  /// Takes answers and asks again when it is time. Call whenever the bus wakes.
  void follow();

  bool known() const { return !of_.empty(); }
  const std::string& of() const { return of_; }  ///< node whose clock it is; empty: none yet
  ClockOffset::Estimate estimate() const;        ///< theirs minus own, now
  std::int64_t round_trip_ns() const { return round_trip_; }
  std::int64_t to_own(std::int64_t theirs_ns) const {
    return theirs_ns - offset_;
  }  ///< a time of theirs on this node's clock

 private:
  void take(const ClockAnswer& answer);

  std::unique_ptr<Writer<ClockProbe>> probes_;
  std::unique_ptr<Reader<ClockAnswer>> answers_;
  ClockProbe probe_;
  ClockReading clock_;
  std::string of_, host_;
  ClockOffset offsets_;
  bool same_host_ = false;
  std::int64_t offset_ = 0, round_trip_ = 0, asked_ns_ = 0;
};

}  // namespace palpate
