// Archives of tensors and readings of mesh files: what is there, and away with it.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/archive/archive_place.hpp"
#include "common/mesh/kept_reading.hpp"
#include "common/scene/find_archive.hpp"
#include "common/scene/scene.hpp"
#include "tools/shared/commands.hpp"
#include "tools/shared/human_bytes.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHashDigits = 32;

struct CacheOptions {
  std::string work;
  std::vector<std::string> scenes;
  int days = 0;
  bool old_formats = false, json = false;
};

struct Kept {
  fs::path file;
  std::uintmax_t bytes = 0;
  std::chrono::sys_seconds made;
  std::string body, hash;  ///< of an archive
};

bool is_hash(std::string_view text) {
  return text.size() == kHashDigits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// An archive by its name, BODY-HASH.h5; nothing else in such a folder is looked at.
bool is_archive(Kept& kept) {
  const std::string name = kept.file.stem().string();
  if (kept.file.extension() != ".h5" || name.size() < kHashDigits + 2) return false;
  kept.body = name.substr(0, name.size() - kHashDigits - 1);
  kept.hash = name.substr(name.size() - kHashDigits);
  return name[kept.body.size()] == '-' && is_hash(kept.hash);
}

bool is_reading(const Kept& kept) {
  return is_hash(kept.file.filename().string());
}

template <class IsWanted>
std::vector<Kept> files_in(const fs::path& folder, IsWanted&& is_wanted) {
  std::vector<Kept> all;
  if (!fs::is_directory(folder)) return all;
  for (const auto& entry : fs::directory_iterator(folder)) {
    Kept kept{entry.path(), 0, {}, {}, {}};
    if (!entry.is_regular_file() || entry.is_symlink() || !is_wanted(kept)) continue;
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

bool archive_is_of_use(const Kept& kept) {
  try {
    read_archive(kept.file, ArchivePart::header, kept.hash);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

bool reading_is_of_use(const Kept& kept) {
  return kept_answer(kept.file).has_value();
}

std::uintmax_t bytes_of(const std::vector<Kept>& files) {
  std::uintmax_t bytes = 0;
  for (const Kept& kept : files) bytes += kept.bytes;
  return bytes;
}

nlohmann::ordered_json json_of(const Kept& kept) {
  return {{"file", kept.file.string()},
          {"body", kept.body},
          {"bytes", kept.bytes},
          {"made", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", kept.made)},
          {"usable", archive_is_of_use(kept)}};
}

void print_json(const fs::path& folder, const std::vector<Kept>& archives, const std::vector<Kept>& readings) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Kept& kept : archives) list.push_back(json_of(kept));
  const nlohmann::ordered_json json{{"folder", folder.string()},
                                    {"archives", list},
                                    {"readings", readings.size()},
                                    {"reading_bytes", bytes_of(readings)}};
  fmt::print("{}\n", json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void list(const CacheOptions& o) {
  for (const fs::path& folder : folders_of(o.scenes)) {
    const std::vector<Kept> archives = files_in(folder, is_archive);
    if (o.json) {
      print_json(folder, archives, files_in(readings_folder(folder), is_reading));
      continue;
    }
    for (const Kept& kept : archives)
      fmt::print("  {:>10}  {:%Y-%m-%d}  {:<20}  {}{}\n", human_bytes(kept.bytes), kept.made, kept.body,
                 kept.file.filename().string(), archive_is_of_use(kept) ? "" : "  (of no use to this version)");
    fmt::print("{}: {} archives, {}\n", folder.string(), archives.size(), human_bytes(bytes_of(archives)));
    const fs::path below = readings_folder(folder);
    if (const std::vector<Kept> readings = files_in(below, is_reading); !readings.empty())
      fmt::print("{}: {} readings of mesh files, {}\n", below.string(), readings.size(),
                 human_bytes(bytes_of(readings)));
  }
}

/// Removes those that the options mean, and returns them.
template <class IsOfUse>
std::vector<Kept> remove(std::vector<Kept> files, const CacheOptions& o, IsOfUse&& is_of_use) {
  const auto now = std::chrono::system_clock::now();
  std::erase_if(files, [&](const Kept& kept) {
    return now - kept.made < std::chrono::days(o.days) || (o.old_formats && is_of_use(kept));
  });
  for (const Kept& kept : files) fs::remove(kept.file);
  return files;
}

void clean(const CacheOptions& o) {
  for (const fs::path& folder : folders_of(o.scenes)) {
    const std::vector<Kept> archives = remove(files_in(folder, is_archive), o, archive_is_of_use);
    fmt::print("{}: {} archives removed, {}\n", folder.string(), archives.size(), human_bytes(bytes_of(archives)));
    const fs::path below = readings_folder(folder);
    const std::vector<Kept> readings = remove(files_in(below, is_reading), o, reading_is_of_use);
    if (!readings.empty())
      fmt::print("{}: {} readings of mesh files removed, {}\n", below.string(), readings.size(),
                 human_bytes(bytes_of(readings)));
  }
}

}  // namespace

void add_cache_command(cli::Command& app) {
  cli::Command command = app.add_command(
      "cache", "List or remove archives of tensors and readings of mesh files, which can be made again");
  auto o = std::make_shared<CacheOptions>();
  command.add_option("WORK", o->work, "list, or clean").required().one_of(std::vector<std::string>{"list", "clean"});
  command.add_option("SCENE", o->scenes, "Scenes beside whose meshes to look (default: the user's own folder)");
  command.add_option("--days", o->days, "Remove what is at least so many days old").between(0, 36500).show_default();
  command.add_flag("--unusable", o->old_formats, "Remove only what this version cannot use: older formats, damaged");
  command.add_flag("--json", o->json, "Of a list: print one line of JSON a folder");
  command.examples({"palpate cache list", "palpate cache list scenes/liver.toml", "palpate cache clean --unusable",
                    "palpate cache clean --days 30"});
  command.does([o] { o->work == "list" ? list(*o) : clean(*o); });
}

}  // namespace palpate
