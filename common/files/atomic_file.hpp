#pragma once
#include <cstddef>
#include <filesystem>

namespace palpate {

/// A file that appears whole or not at all: it is written in the target's folder, under a temporary name that nobody
/// can foresee, synced to disk, and renamed. Without commit() the temporary file is removed again.
class AtomicFile {
 public:
  /// Makes the folder if needed, removes temporary files whose writers were killed, and reserves
  /// `expected_bytes` on the disk. Throws std::runtime_error if any of it fails (a full disk is found here).
  AtomicFile(std::filesystem::path target, std::size_t expected_bytes);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& path() const { return temporary_; }
  void commit();

 private:
  std::filesystem::path target_, temporary_;
};

}  // namespace palpate
