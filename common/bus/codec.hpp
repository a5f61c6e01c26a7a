#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// Messages as bytes, the way logs hold them: fields in order without padding, little-endian; arrays one
/// element after the other; strings and sequences after a u32 count. The schema text describes exactly this. Here for
/// the messages of the bus, and for what log_format.hpp adds.
namespace palpate {

using Bytes = std::vector<std::uint8_t>;

/// Appends the message to `out`.
template <class M>
void encode(const M& message, Bytes& out);

/// True if the bytes are exactly one message; only then is it complete. Never reads beyond the bytes.
template <class M>
bool decode(std::span<const std::uint8_t> bytes, M& message);

/// "ToolState: tool u32, run u64, …": one line for a message or a struct in one, and its encoding.
template <class M>
std::string schema_line();

}  // namespace palpate
