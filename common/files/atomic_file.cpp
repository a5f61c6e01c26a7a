#include "common/files/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>

namespace palpate {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kMark = ".tmp-";

[[noreturn]] void fail(const fs::path& file, int error) {
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(error)));
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

std::string temporary_name(const std::string& target, int process, std::uint64_t random) {
  return fmt::format("{}{}{}-{:016x}{}", target, kMark, process, random, fs::path(target).extension().string());
}

/// The process that writes a temporary file of the target, from the file's name; 0 if it is none of these.
int writer_of(const std::string& name, const std::string& target) {
  if (!name.starts_with(target) || !std::string_view(name).substr(target.size()).starts_with(kMark)) return 0;
  const char* const end = name.data() + name.size();
  int process = 0;
  const auto number = std::from_chars(name.data() + target.size() + kMark.size(), end, process);
  std::uint64_t random = 0;
  if (number.ptr != end) std::from_chars(number.ptr + 1, end, random, 16);
  return process > 0 && name == temporary_name(target, process, random) ? process : 0;
}

void remove_abandoned(const fs::path& target) {
  std::error_code ignored;
  const std::string name = target.filename().string();
  for (const auto& entry : fs::directory_iterator(folder_of(target), ignored)) {
    const int process = writer_of(entry.path().filename().string(), name);
    if (process > 0 && kill(process, 0) != 0 && errno == ESRCH) fs::remove(entry.path(), ignored);
  }
}

constexpr mode_t kMode = 0666;  // less the umask

/// Returns a descriptor, or -1 with errno.
int open_unnamed(const fs::path& folder) {
  return open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kMode);
}
int open_named(const fs::path& file) {
  return open(file.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, kMode);
}

/// Returns 0 or an errno.
int reserve(int descriptor, std::size_t bytes) {
  rlimit limit{};
  // Beyond the limit the kernel would send SIGXFSZ instead of returning an error.
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && bytes > limit.rlim_cur) return EFBIG;
  return bytes > 0 ? posix_fallocate(descriptor, 0, static_cast<off_t>(bytes)) : 0;
}

/// So that the new name lasts too.
void sync_folder(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace

void make_folder_of(const fs::path& file) {
  std::error_code error;
  fs::create_directories(folder_of(file), error);
  if (error) fail(file, error.value());
}

AtomicFile::AtomicFile(const fs::path& target, std::size_t expected_bytes, Temporary temporary) : target_(target) {
  remove_abandoned(target_);
  std::random_device random;
  temporary_ = temporary_name(target_.string(), getpid(), std::uint64_t{random()} << 32 | random());
  if (temporary == Temporary::unnamed) descriptor_ = open_unnamed(folder_of(target_));
  if (descriptor_ < 0) {
    descriptor_ = open_named(temporary_);
    has_name_ = descriptor_ >= 0;
  }
  if (descriptor_ < 0) fail(target_, errno);
  if (const int error = reserve(descriptor_, expected_bytes); error != 0) {
    let_go();
    fail(target_, error);
  }
}

AtomicFile::~AtomicFile() {
  let_go();
}

void AtomicFile::let_go() {
  close(descriptor_);
  std::error_code ignored;
  if (has_name_) fs::remove(temporary_, ignored);
}

fs::path AtomicFile::handle() const {
  return fmt::format("/proc/self/fd/{}", descriptor_);
}

void AtomicFile::commit() {
  if (fsync(descriptor_) != 0) fail(target_, errno);
  if (!has_name_ && linkat(AT_FDCWD, handle().c_str(), AT_FDCWD, temporary_.c_str(), AT_SYMLINK_FOLLOW) != 0)
    fail(target_, errno);
  has_name_ = true;
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) fail(target_, error.value());
  has_name_ = false;
  sync_folder(folder_of(target_));
}

}  // namespace palpate
