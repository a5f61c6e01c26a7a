#pragma once
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <span>
#include <sstream>
#include <vector>

namespace palpate::testing {

/// What one direction of a bad network does to packets.
struct Impairment {
  double delay = 0;      ///< [s] added to each
  double jitter = 0;     ///< [s] up to so much more, evenly spread; the order is kept
  double loss = 0;       ///< [1] share that disappears
  double duplicate = 0;  ///< [1] share that arrives twice
  double reorder = 0;    ///< [1] share that those of the next 5 ms overtake
  double rate = 0;       ///< [bit/s] of the line, 0: unlimited
  double queue = 64e3;   ///< [byte] that wait for the line at most; what comes then is lost
  bool cut = false;      ///< nothing arrives, and what is on its way is lost
};

/// Changes what the words say, as in "delay 0.1 loss 0.3 cut 1"; "clear" sets everything back. False if one is not
/// understood.
bool change(Impairment& impairment, std::istream& words);

/// One direction: packets go in, and come out when they are due. Chances come from the seed alone.
class Lane {
 public:
  using Packet = std::vector<std::uint8_t>;
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

  explicit Lane(std::uint64_t seed) : random_(seed) {}
  void set(const Impairment& impairment);
  const Impairment& impairment() const { return impairment_; }

  void put(std::span<const std::uint8_t> packet, std::int64_t now_ns);
  std::optional<Packet> take(std::int64_t now_ns);  ///< the next that is due, if any
  std::int64_t next_due() const { return waiting_.empty() ? kNever : waiting_.begin()->first; }

 private:
  bool chance(double share) { return share > 0 && uniform() < share; }
  double uniform() { return 0x1p-53 * static_cast<double>(random_() >> 11); }
  std::optional<std::int64_t> cross_line(std::size_t bytes, std::int64_t now_ns);
  void send(std::span<const std::uint8_t> packet, std::int64_t now_ns);

  Impairment impairment_;
  std::mt19937_64 random_;
  std::multimap<std::int64_t, Packet> waiting_;  ///< by the time when they are due
  std::int64_t line_free_ = 0, last_due_ = 0;
};

}  // namespace palpate::testing
