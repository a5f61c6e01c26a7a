#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "common/bus/key.hpp"

namespace palpate {

/// Checks the sequence numbers of one topic's streams (key and run). Before the first sample nothing is
/// missing: a recorder may join late.
class SequenceCheck {
 public:
  template <class M>
  void add(const M& message) {
    add(key_of(message), run_of(message), message.seq);
  }
  void add(const std::string& key, std::uint64_t run, std::uint64_t seq);

  std::uint64_t gaps() const { return gaps_; }          ///< places where numbers are missing
  std::uint64_t missing() const { return missing_; }    ///< numbers that never came
  std::uint64_t repeated() const { return repeated_; }  ///< numbers seen before, or out of order
  std::size_t streams() const { return next_.size(); }

 private:
  std::map<std::pair<std::string, std::uint64_t>, std::uint64_t> next_;
  std::uint64_t gaps_ = 0, missing_ = 0, repeated_ = 0;
};

}  // namespace palpate
