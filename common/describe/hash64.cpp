#include "common/describe/hash64.hpp"

#include <xxhash.h>

namespace palpate {

Hash64::Hash64() : state_(XXH3_createState()) {
  XXH3_64bits_reset(state_.get());
}

void Hash64::Free::operator()(XXH3_state_s* state) const {
  XXH3_freeState(state);
}

void Hash64::add_bytes(const void* data, std::size_t size) {
  XXH3_64bits_update(state_.get(), data, size);
}

std::uint64_t Hash64::value() const {
  return XXH3_64bits_digest(state_.get());
}

}  // namespace palpate
