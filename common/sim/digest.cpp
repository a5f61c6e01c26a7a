#include "common/sim/digest.hpp"

#include <xxhash.h>

namespace palpate::sim {

Digest::Digest() : state_(XXH3_createState()) {
  XXH3_64bits_reset(state_.get());
}

void Digest::Free::operator()(XXH3_state_s* state) const {
  XXH3_freeState(state);
}

void Digest::add_bytes(const void* data, std::size_t size) {
  XXH3_64bits_update(state_.get(), data, size);
}

std::uint64_t Digest::value() const {
  return XXH3_64bits_digest(state_.get());
}

}  // namespace palpate::sim
