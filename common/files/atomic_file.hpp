#pragma once
#include <cstddef>
#include <filesystem>

namespace palpate {

/// Makes the folder that a file is to lie in. Throws std::runtime_error if that fails.
void make_folder_of(const std::filesystem::path& file);

/// A file that appears whole or not at all: it is written in the target's folder, under a temporary name that nobody
/// can foresee, synced to disk, and renamed. Without commit() the temporary file is removed again.
class AtomicFile {
 public:
  /// Removes temporary files of this target whose writers were killed, and creates one of its own, `expected_bytes`
  /// reserved on the disk. Throws std::runtime_error if any of it fails (a full disk is found here).
  explicit AtomicFile(const std::filesystem::path& target, std::size_t expected_bytes = 0);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// The temporary name, which ends as the target's does.
  const std::filesystem::path& path() const { return temporary_; }
  /// A name by which this process opens the temporary file itself, whatever somebody puts in the place of path().
  std::filesystem::path handle() const;
  int descriptor() const { return descriptor_; }  ///< open for reading and writing

  /// Gives it the target's name. What is written afterwards through a file opened before goes on into it.
  void commit();

 private:
  std::filesystem::path target_, temporary_;
  int descriptor_ = -1;
};

}  // namespace palpate
