#include "tools/study/output_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>

namespace palpate {
namespace {

namespace fs = std::filesystem;

/// Whether there is more than nothing.
bool is_there(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error) && (!fs::is_regular_file(file, error) || fs::file_size(file, error) > 0);
}

bool begins(const fs::path& file, const std::string& beginning) {
  std::string bytes(beginning.size(), '\0');
  std::ifstream in(file, std::ios::binary);
  return in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) && bytes == beginning;
}

[[noreturn]] void keep(const fs::path& file) {
  throw std::runtime_error(
      fmt::format("{}: not made by this command, so it stays; name another folder", file.string()));
}

}  // namespace

void prepare_folder(const fs::path& folder, const OwnFile& own, const std::vector<std::string>& others) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw std::runtime_error(fmt::format("{}: the folder cannot be made: {}", folder.string(), error.message()));
  if (access(folder.c_str(), W_OK) != 0)
    throw std::runtime_error(fmt::format("{}: the folder cannot be written", folder.string()));
  if (begins(folder / own.name, own.beginning)) return;
  if (is_there(folder / own.name)) keep(folder / own.name);
  for (const std::string& other : others)
    if (is_there(folder / other)) keep(folder / other);
}

}  // namespace palpate
