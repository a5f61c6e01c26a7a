#include "common/files/file_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <utility>

namespace palpate {

FileLock FileLock::wait_for(const std::filesystem::path& path) {
  std::error_code unknown;
  const bool folder = std::filesystem::is_directory(path, unknown);
  FileLock lock(open(path.c_str(), (folder ? O_RDONLY : O_RDWR | O_CREAT) | O_CLOEXEC | O_NOFOLLOW, 0666));
  if (lock.descriptor_ >= 0) flock(lock.descriptor_, LOCK_EX);
  return lock;
}

FileLock FileLock::at_once(const std::filesystem::path& path) {
  FileLock lock(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (lock.descriptor_ >= 0 && flock(lock.descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw std::runtime_error(fmt::format("{}: another program is writing it: give another name", path.string()));
  return lock;
}

FileLock::FileLock(FileLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

FileLock& FileLock::operator=(FileLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

FileLock::~FileLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace palpate
