#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "common/bus/log_reader.hpp"
#include "common/bus/thinning.hpp"
#include "common/scene/moved_files.hpp"

namespace palpate {

/// What a log takes along [bytes]: files beyond it, and those for which all together leave no room, go by their hash
/// alone.
inline constexpr std::uint64_t kMaxLogFile = 16u << 20, kLogFiles = 48u << 20;

/// What a scene names, for a log of it: each file's hash, and its contents while there is room. Files that are not
/// here, or that no scene would name, are left out.
std::vector<LogFile> files_for_log(const Scene& scene);
/// The same of a resolved scene as a haptic node published it; nothing if it cannot be read here.
std::vector<LogFile> files_for_log(const std::string& scene_text);

/// What a long log of a resolved scene goes without; nothing if the scene cannot be read here.
Thinning thinning_for_log(const std::string& scene_text);

/// The haptic node's archives, as the log's first message about it says: the hashes of all bodies; empty if none does.
std::string recorded_archive_hash(const std::filesystem::path& log);

/// The scene of a log, wherever it was recorded.
class LoggedScene {
 public:
  /// Finds each file that the scene names: where it was, if it is as it was; in a folder `data`, if that is not empty,
  /// by what is in it; or in the log, from which it is written into `data` or, without one, a folder that lives as
  /// long as this object. Throws std::runtime_error, with the hash of what is missing, or if the haptic node had other
  /// files than those, or the log holds another scene too.
  LoggedScene(const std::filesystem::path& log, const std::filesystem::path& data);
  ~LoggedScene();
  LoggedScene(const LoggedScene&) = delete;
  LoggedScene& operator=(const LoggedScene&) = delete;

  const Scene& scene() const { return scene_; }
  /// Throws std::runtime_error where two runs stand in the log at once: they are no one session.
  void require_one_run() const;
  /// Computes the archives that are not here, and says so on standard error. Returns the bodies that it did so for.
  /// Throws as ensure_archive() does.
  std::vector<std::string> ensure_archives() const;

 private:
  void find_files(MovedFiles& moved);
  void require_same_archives() const;
  void require_one_scene(LogReader& reader, std::int64_t begin_ns) const;
  std::filesystem::path place_of(const LogFile& file);
  const std::filesystem::path& folder();

  std::filesystem::path log_, data_, own_folder_;
  Scene scene_;
};

}  // namespace palpate
