#include "common/bus/sequence.hpp"

namespace palpate {

void SequenceCheck::add(const std::string& key, std::uint64_t run, std::uint64_t seq) {
  const auto [stream, is_new] = next_.try_emplace({key, run}, seq + 1);
  if (is_new) return;
  std::uint64_t& next = stream->second;
  if (seq < next) {
    ++repeated_;
    return;
  }
  if (seq > next) {
    ++gaps_;
    missing_ += seq - next;
  }
  next = seq + 1;
}

}  // namespace palpate
