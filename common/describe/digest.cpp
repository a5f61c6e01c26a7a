#include "common/describe/digest.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <cstdio>
#include <memory>
#include <stdexcept>
#include <vector>

namespace palpate {
namespace {

std::string hexadecimal(XXH128_hash_t hash) {
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace

std::string digest(const void* data, std::size_t bytes) {
  return hexadecimal(XXH3_128bits(data, bytes));
}

std::string digest(std::string_view text) {
  return digest(text.data(), text.size());
}

std::string file_digest(const std::filesystem::path& file) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), std::fclose);
  if (!stream) throw std::runtime_error(file.string() + ": the file cannot be read");
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(), XXH3_freeState);
  XXH3_128bits_reset(state.get());
  std::vector<char> buffer(1 << 20);
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), stream.get()))
    XXH3_128bits_update(state.get(), buffer.data(), count);
  if (std::ferror(stream.get())) throw std::runtime_error(file.string() + ": the file cannot be read");
  return hexadecimal(XXH3_128bits_digest(state.get()));
}

}  // namespace palpate
