#pragma once
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace palpate::testing {

/// What a process has written so far of files in a folder that have no name yet [bytes].
inline std::uintmax_t bytes_on_the_way(pid_t process, const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::uintmax_t bytes = 0;
  std::error_code gone;
  for (const auto& open : fs::directory_iterator("/proc/" + std::to_string(process) + "/fd", gone)) {
    const std::string file = fs::read_symlink(open.path(), gone).string();
    if (gone || !file.starts_with(fs::canonical(folder).string()) || !file.ends_with(" (deleted)")) continue;
    if (const std::uintmax_t size = fs::file_size(open.path(), gone); !gone) bytes += size;
  }
  return bytes;
}

}  // namespace palpate::testing
