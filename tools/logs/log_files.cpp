#include "tools/logs/log_files.hpp"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "common/bus/log_reader.hpp"
#include "common/bus/runs_at_once.hpp"
#include "common/describe/digest.hpp"
#include "common/models/content_hash.hpp"
#include "idl/topics.hpp"
#include "tools/logs/scene_title.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

/// A resolved scene that came over a network may name any file: only what a scene is made of goes into a log.
bool is_scene_file(const fs::path& file) {
  constexpr std::array<std::string_view, 10> kEndings{".msh", ".vtk", ".vtu", ".stl", ".csv",
                                                      ".inp", ".obj", ".mtl", ".png", ".lcmlog"};
  return std::ranges::find(kEndings, file.extension().string()) != kEndings.end();
}

Bytes contents_of(const fs::path& file, std::uint64_t size) {
  Bytes bytes(size);
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

std::string hash_of(const Bytes& bytes) {
  return digest(bytes.data(), bytes.size());
}

/// The hash of a file that is here, or nothing.
std::string hash_of(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error) ? file_digest(file) : std::string();
}

LogFile log_file(const fs::path& file, std::uint64_t room) {
  LogFile f{.path = file.string(), .size = fs::file_size(file)};
  if (f.size <= room) {
    f.content = contents_of(file, f.size);
    f.hash = hash_of(f.content);
  } else {
    f.hash = file_digest(file);
  }
  return f;
}

/// A name that no other contents have, with the ending that says how to read them.
std::string name_of(const LogFile& file) {
  std::string ending = fs::path(file.path).extension().string();
  const auto plain = [](unsigned char c) { return c < 128 && (std::isalnum(c) || c == '.'); };
  if (ending.size() > 8 || !std::ranges::all_of(ending, plain)) ending.clear();
  return file.hash + ending;
}

/// A file in the folder with these contents, or nothing.
fs::path find_in(const fs::path& folder, const LogFile& wanted) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    std::error_code error;
    if (entry.is_regular_file(error) && entry.file_size(error) == wanted.size && hash_of(entry.path()) == wanted.hash)
      return entry.path();
  }
  return {};
}

fs::path new_folder() {
  std::string name = (fs::temp_directory_path() / "palpate-log-XXXXXX").string();
  if (!mkdtemp(name.data()))
    throw std::runtime_error(fmt::format("no folder for a log's files: {}: {}", name, std::strerror(errno)));
  return name;
}

}  // namespace

std::vector<LogFile> files_for_log(const Scene& scene) {
  std::vector<LogFile> files;
  std::uint64_t room = kLogFiles;
  for (const fs::path& file : files_of(scene)) {
    std::error_code error;
    if (!is_scene_file(file) || !fs::is_regular_file(file, error)) continue;
    files.push_back(log_file(file, std::min(room, kMaxLogFile)));
    room -= files.back().content.size();
  }
  return files;
}

std::vector<LogFile> files_for_log(const std::string& scene_text) {
  try {
    return files_for_log(parse_scene(scene_text, "scene.toml"));
  } catch (const std::exception&) {
    return {};  // the tools' host has what it names, and this one has not
  }
}

Thinning thinning_for_log(const std::string& scene_text) {
  try {
    const Scene scene = parse_scene(scene_text, "scene.toml");
    Thinning thinning;
    thinning.steps = std::max(1l, std::lround(scene.rates.haptic_hz / scene.rates.visual_hz));
    for (const Body& body : scene.bodies) thinning.redrawn.push_back(owner_of(body) == Owner::haptic_node);
    return thinning;
  } catch (const std::exception&) {
    return {};
  }
}

std::string recorded_archive_hash(const fs::path& log) {
  LogReader reader(log);
  NodeStatus status;
  for (LogEvent event; reader.next(event);)
    if (event.read(topics::node_status, status) && status.role == "haptic" && !status.archive_hash.empty())
      return status.archive_hash;
  return {};
}

LoggedScene::LoggedScene(const fs::path& log, const fs::path& data) : log_(log), data_(data) {
  if (!data_.empty() && !fs::is_directory(data_))
    throw std::runtime_error(fmt::format("--data: {} is no folder", data_.string()));
  LogReader reader(log);
  LogEvent event;
  while (reader.header().scene.empty() && reader.next(event)) {
  }
  if (reader.header().scene.empty())
    throw std::runtime_error(
        fmt::format("{}: the log holds no scene, so nothing of it can be drawn or computed again", log.string()));
  require_one_scene(reader, event.receive_ns);
  MovedFiles moved;
  find_files(moved);
  scene_ = parse_scene(reader.header().scene, log, moved);
  require_same_archives();
}

/// Reads on to the end.
void LoggedScene::require_one_scene(LogReader& reader, std::int64_t begin_ns) const {
  SceneText scene;
  for (LogEvent event; reader.next(event);) {
    if (!event.read(topics::scene, scene) || scene.scene_hash == reader.header().scene_hash) continue;
    throw std::runtime_error(fmt::format(
        "{}: it holds two scenes, '{}' and, {:.1f} s later, '{}'; what is drawn, reported or verified is of "
        "one: record each by itself",
        log_.string(), title_of(reader.header().scene), 1e-9 * static_cast<double>(event.receive_ns - begin_ns),
        title_of(scene.text)));
  }
}

void LoggedScene::require_one_run() const {
  if (const std::string two = runs_at_once(log_); !two.empty())
    throw std::runtime_error(
        fmt::format("{}: {}; what is drawn or reported is of one: record each by itself", log_.string(), two));
}

// One at a time: a log may hold more than the memory.
void LoggedScene::find_files(MovedFiles& moved) {
  LogReader reader(log_);
  for (LogFile file; reader.next_file(file);) moved[file.path] = place_of(file);
}

void LoggedScene::require_same_archives() const {
  const std::string recorded = recorded_archive_hash(log_);
  std::string here;
  for (const Body& body : scene_.bodies) here += content_hash(body);
  if (!here.starts_with(recorded))  // the message has room for the first ones alone
    throw std::runtime_error(fmt::format(
        "{}: the haptic node had other meshes or curves than those here: its archives have the hashes {}, these {}",
        log_.string(), recorded, here));
}

LoggedScene::~LoggedScene() {
  std::error_code error;
  if (!own_folder_.empty()) fs::remove_all(own_folder_, error);
}

const fs::path& LoggedScene::folder() {
  if (!data_.empty()) return data_;
  if (own_folder_.empty()) own_folder_ = new_folder();
  return own_folder_;
}

fs::path LoggedScene::place_of(const LogFile& file) {
  if (hash_of(fs::path(file.path)) == file.hash) return file.path;
  if (!data_.empty())
    if (const fs::path found = find_in(data_, file); !found.empty()) return fs::absolute(found);
  if (file.content.empty() && file.size > 0)
    throw std::runtime_error(
        fmt::format("{}: {} is not here as it was, and too large to be in the log: give the folder of a file with the "
                    "hash {} as --data",
                    log_.string(), file.path, file.hash));
  if (hash_of(file.content) != file.hash)
    throw std::runtime_error(
        fmt::format("{}: what the log holds of {} is not what its hash {} says", log_.string(), file.path, file.hash));
  fs::path place = fs::absolute(folder() / name_of(file));
  std::ofstream out(place, std::ios::binary);
  out.write(reinterpret_cast<const char*>(file.content.data()), static_cast<std::streamsize>(file.content.size()));
  if (!out.flush()) throw std::runtime_error(fmt::format("{}: cannot be written", place.string()));
  return place;
}

}  // namespace palpate
