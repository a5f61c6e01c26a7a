#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace palpate {

/// XXH3, 128 bits, as 32 hexadecimal digits.
std::string digest(const void* data, std::size_t bytes);
std::string digest(std::string_view text);

/// Of a file's contents. Throws std::runtime_error("FILE: sentence") if it cannot be read.
std::string file_digest(const std::filesystem::path& file);

}  // namespace palpate
