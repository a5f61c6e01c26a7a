// Archives of tensors: what is there, and away with it.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/archive/archive_place.hpp"
#include "common/scene/find_archive.hpp"
#include "common/scene/scene.hpp"
#include "tools/commands.hpp"
#include "tools/human_bytes.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHashDigits = 32;

struct CacheOptions {
  std::string work;
  std::vector<std::string> scenes;
  int days = 0;
  bool old_formats = false;
};

struct Kept {
  fs::path file;
  std::uintmax_t bytes = 0;
  std::chrono::sys_seconds made;
  std::string body, hash;
};

/// An archive by its name, BODY-HASH.h5; nothing else in such a folder is looked at.
bool is_archive(const fs::path& file, Kept& kept) {
  const std::string name = file.stem().string();
  if (file.extension() != ".h5" || name.size() < kHashDigits + 2) return false;
  kept.file = file;
  kept.body = name.substr(0, name.size() - kHashDigits - 1);
  kept.hash = name.substr(name.size() - kHashDigits);
  return name[kept.body.size()] == '-' && kept.hash.find_first_not_of("0123456789abcdef") == std::string::npos;
}

std::vector<Kept> archives_in(const fs::path& folder) {
  std::vector<Kept> all;
  if (!fs::is_directory(folder)) return all;
  for (const auto& entry : fs::directory_iterator(folder)) {
    Kept kept;
    if (!entry.is_regular_file() || entry.is_symlink() || !is_archive(entry.path(), kept)) continue;
    kept.bytes = entry.file_size();
    kept.made = std::chrono::floor<std::chrono::seconds>(std::chrono::file_clock::to_sys(entry.last_write_time()));
    all.push_back(std::move(kept));
  }
  std::ranges::sort(all, {}, &Kept::file);
  return all;
}

/// The folders of the scenes' archives; without a scene the user's own.
std::set<fs::path> folders_of(const std::vector<std::string>& scenes) {
  if (scenes.empty()) return {archive_cache()};
  std::set<fs::path> folders;
  for (const std::string& file : scenes)
    for (const Body& body : load_scene(file).bodies)
      if (const fs::path archive = archive_path(body); !archive.empty()) folders.insert(archive.parent_path());
  return folders;
}

/// Why this version does not use it; empty: it does.
std::string refusal(const Kept& kept) {
  try {
    read_archive(kept.file, ArchivePart::header, kept.hash);
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

void list(const CacheOptions& o) {
  for (const fs::path& folder : folders_of(o.scenes)) {
    std::uintmax_t all = 0;
    const std::vector<Kept> archives = archives_in(folder);
    for (const Kept& kept : archives) {
      all += kept.bytes;
      fmt::print("  {:>10}  {:%Y-%m-%d}  {:<20}  {}{}\n", human_bytes(kept.bytes), kept.made, kept.body,
                 kept.file.filename().string(), refusal(kept).empty() ? "" : "  (of no use to this version)");
    }
    fmt::print("{}: {} archives, {}\n", folder.string(), archives.size(), human_bytes(all));
  }
}

void clean(const CacheOptions& o) {
  const auto now = std::chrono::system_clock::now();
  for (const fs::path& folder : folders_of(o.scenes)) {
    std::uintmax_t bytes = 0;
    int removed = 0;
    for (const Kept& kept : archives_in(folder)) {
      if (now - kept.made < std::chrono::days(o.days) || (o.old_formats && refusal(kept).empty())) continue;
      fs::remove(kept.file);
      bytes += kept.bytes, ++removed;
    }
    fmt::print("{}: {} archives removed, {}\n", folder.string(), removed, human_bytes(bytes));
  }
}

}  // namespace

void add_cache_command(cli::Command& app) {
  cli::Command command = app.add_command("cache", "List or remove archives of tensors, which can be computed again");
  auto o = std::make_shared<CacheOptions>();
  command.add_option("WORK", o->work, "list, or clean").required().one_of(std::vector<std::string>{"list", "clean"});
  command.add_option("SCENE", o->scenes, "Scenes beside whose meshes to look (default: the user's own folder)");
  command.add_option("--days", o->days, "Remove what is at least so many days old").between(0, 36500).show_default();
  command.add_flag("--unusable", o->old_formats, "Remove only what this version cannot use: older formats, damaged");
  command.examples({"palpate cache list", "palpate cache list scenes/liver.toml", "palpate cache clean --unusable",
                    "palpate cache clean --days 30"});
  command.does([o] { o->work == "list" ? list(*o) : clean(*o); });
}

}  // namespace palpate
