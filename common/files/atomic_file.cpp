#include "common/files/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
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

/// The process that writes a temporary file, from its name, or 0.
int writer_of(const std::string& name) {
  const auto mark = name.rfind(kMark);
  if (mark == std::string::npos) return 0;
  int process = 0;
  std::from_chars(name.data() + mark + kMark.size(), name.data() + name.size(), process);
  return process;
}

void remove_abandoned(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const int process = writer_of(entry.path().filename().string());
    if (process > 0 && kill(process, 0) != 0 && errno == ESRCH) fs::remove(entry.path(), ignored);
  }
}

/// Returns 0 or an errno.
int reserve(const fs::path& file, std::size_t bytes) {
  rlimit limit{};
  // Beyond the limit the kernel would send SIGXFSZ instead of returning an error.
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && bytes > limit.rlim_cur) return EFBIG;
  const int descriptor = open(file.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0644);
  if (descriptor < 0) return errno;
  const int error = posix_fallocate(descriptor, 0, static_cast<off_t>(bytes));
  close(descriptor);
  return error;
}

int sync_to_disk(const fs::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int error = fsync(descriptor) == 0 ? 0 : errno;
  close(descriptor);
  return error;
}

}  // namespace

AtomicFile::AtomicFile(fs::path target, std::size_t expected_bytes) : target_(std::move(target)) {
  std::error_code error;
  fs::create_directories(target_.parent_path(), error);
  if (error) fail(target_, error.value());
  remove_abandoned(target_.parent_path());
  std::random_device random;
  temporary_ = fmt::format("{}{}{}-{:08x}{:08x}", target_.string(), kMark, getpid(), random(), random());
  const int reserved = reserve(temporary_, expected_bytes);
  if (reserved == 0) return;
  if (reserved != EEXIST) fs::remove(temporary_, error);  // else it is another's
  fail(target_, reserved);
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  if (const int error = sync_to_disk(temporary_)) fail(target_, error);
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) fail(target_, error.value());
  sync_to_disk(target_.parent_path());
}

}  // namespace palpate
