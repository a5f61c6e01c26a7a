#pragma once
#include <filesystem>

namespace palpate {

/// That no other process has a file or folder at the same time; it ends with the object. Where the path cannot be
/// opened it holds nothing.
class FileLock {
 public:
  FileLock() = default;
  /// Waits until nobody else has it; a file that is not there is made.
  static FileLock wait_for(const std::filesystem::path& path);
  /// Throws std::runtime_error if somebody else has it.
  static FileLock at_once(const std::filesystem::path& path);
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&& other) noexcept;
  ~FileLock();

 private:
  explicit FileLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

}  // namespace palpate
