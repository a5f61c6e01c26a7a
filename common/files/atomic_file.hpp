#pragma once
#include <cstddef>
#include <filesystem>

namespace palpate {

/// Makes the folder that a file is to lie in. Throws std::runtime_error if that fails.
void make_folder_of(const std::filesystem::path& file);

/// A file that appears whole or not at all: it is written in the target's folder without a name, so that nothing is
/// left of it however its writer ends, or under a temporary one that nobody can foresee, synced to disk, and named.
/// Without commit() it is gone again.
class AtomicFile {
 public:
  /// `named`: for what opens files by names that end as the target's does. Where the file system knows no files without
  /// a name, all have a temporary one.
  enum class Temporary { unnamed, named };

  /// Removes temporary files of this target whose writers were killed, and creates one of its own, `expected_bytes`
  /// reserved on the disk. Throws std::runtime_error if any of it fails (a full disk is found here).
  explicit AtomicFile(const std::filesystem::path& target, std::size_t expected_bytes = 0,
                      Temporary temporary = Temporary::unnamed);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// The temporary name of one that is `named`.
  const std::filesystem::path& path() const { return temporary_; }
  /// A name by which this process opens the temporary file itself, whatever somebody puts in the place of path().
  std::filesystem::path handle() const;
  int descriptor() const { return descriptor_; }  ///< open for reading and writing

  /// Gives it the target's name. What is written afterwards through a file opened before goes on into it.
  void commit();

 private:
  void let_go();

  std::filesystem::path target_, temporary_;
  bool has_name_ = false;
  int descriptor_ = -1;
};

}  // namespace palpate
