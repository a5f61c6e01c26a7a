#include "tools/organ/picture_folder.hpp"

#include <fmt/format.h>

#include <regex>
#include <stdexcept>
#include <vector>

#include "render_node/image.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

/// Files that have the names of pictures.
std::vector<fs::path> named_as_pictures(const fs::path& folder) {
  static const std::regex name(R"(slice_\d{4,}\.png|surface\.png)");
  std::vector<fs::path> found;
  if (!folder.empty() && fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder))
      if (std::regex_match(entry.path().filename().string(), name)) found.push_back(entry.path());
  return found;
}

}  // namespace

void check_picture_folder(const fs::path& folder) {
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw std::runtime_error(fmt::format("{}: it is a file; name a folder for the pictures", folder.string()));
  for (const fs::path& file : named_as_pictures(folder))
    if (fs::is_symlink(file) || !fs::is_regular_file(file) || !is_own_png(file))
      throw std::runtime_error(
          fmt::format("{}: not made by this command, so it stays; name another folder", file.string()));
}

void make_picture_folder(const fs::path& folder) {
  check_picture_folder(folder);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(fmt::format("{}: {}", folder.string(), error.message()));
  for (const fs::path& old : named_as_pictures(folder)) fs::remove(old, error);
}

}  // namespace palpate
