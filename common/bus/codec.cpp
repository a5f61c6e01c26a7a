#include "common/bus/codec_visitors.hpp"

namespace palpate {

#define PALPATE_CODEC(M)                                           \
  template void encode(const M& message, Bytes& out);              \
  template bool decode(std::span<const std::uint8_t>, M& message); \
  template std::string schema_line<M>();
PALPATE_MESSAGES(PALPATE_CODEC)
#undef PALPATE_CODEC

#define PALPATE_SCHEMA(M) template std::string schema_line<M>();
PALPATE_PARTS(PALPATE_SCHEMA)
#undef PALPATE_SCHEMA

}  // namespace palpate
