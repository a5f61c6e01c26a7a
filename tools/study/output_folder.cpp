#include "tools/study/output_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>

namespace palpate {

void prepare_folder(const std::filesystem::path& folder, const std::string& table, const std::string& heading) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw std::runtime_error(fmt::format("{}: the folder cannot be made: {}", folder.string(), error.message()));
  if (access(folder.c_str(), W_OK) != 0)
    throw std::runtime_error(fmt::format("{}: the folder cannot be written", folder.string()));
  std::ifstream in(folder / table);
  std::string line;
  if (std::getline(in, line) && line != heading)
    throw std::runtime_error(
        fmt::format("{}: not a table of this command, so it stays; name another folder", (folder / table).string()));
}

}  // namespace palpate
