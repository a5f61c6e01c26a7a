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

/// Returns 0 or an errno.
int create(const fs::path& file, std::size_t bytes, int& descriptor) {
  rlimit limit{};
  // Beyond the limit the kernel would send SIGXFSZ instead of returning an error.
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && bytes > limit.rlim_cur) return EFBIG;
  descriptor = open(file.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666);
  if (descriptor < 0) return errno;
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

AtomicFile::AtomicFile(const fs::path& target, std::size_t expected_bytes) : target_(target) {
  remove_abandoned(target_);
  std::random_device random;
  temporary_ = temporary_name(target_.string(), getpid(), std::uint64_t{random()} << 32 | random());
  const int error = create(temporary_, expected_bytes, descriptor_);
  if (error == 0) return;
  if (descriptor_ >= 0) {  // else it is another's
    close(descriptor_);
    std::error_code ignored;
    fs::remove(temporary_, ignored);
  }
  fail(target_, error);
}

AtomicFile::~AtomicFile() {
  close(descriptor_);
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

fs::path AtomicFile::handle() const {
  return fmt::format("/proc/self/fd/{}", descriptor_);
}

void AtomicFile::commit() {
  if (fsync(descriptor_) != 0) fail(target_, errno);
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) fail(target_, error.value());
  sync_folder(folder_of(target_));
}

}  // namespace palpate
