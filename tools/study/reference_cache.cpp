#include "tools/study/reference_cache.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <optional>
#include <utility>

#include "common/describe/digest.hpp"
#include "common/files/atomic_file.hpp"

namespace palpate::study {
namespace {

std::string sum_of(const std::vector<double>& values) {
  return digest(values.data(), values.size() * sizeof(double));
}

/// Digest, then the numbers; nothing where the file is absent or damaged.
std::optional<std::vector<double>> read_numbers(const std::filesystem::path& file) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file, error);
  constexpr std::size_t head = 32;
  if (error || bytes < head || (bytes - head) % sizeof(double) != 0) return {};
  std::ifstream in(file, std::ios::binary);
  std::string sum(head, ' ');
  std::vector<double> values((bytes - head) / sizeof(double));
  in.read(sum.data(), head);
  in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(bytes - head));
  if (!in || sum != sum_of(values)) return {};
  return values;
}

void keep_numbers(const std::filesystem::path& file, const std::vector<double>& values) try {
  make_folder_of(file);
  AtomicFile whole(file);
  std::ofstream out(whole.handle(), std::ios::binary);
  out << sum_of(values);
  out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(double)));
  out.close();
  if (out) whole.commit();
} catch (const std::runtime_error&) {
  // They are computed again next time.
}

/// Held while a reference is computed, so that other processes wait for it in place of computing it too. Where no file
/// can be locked, they do.
class Turn {
 public:
  explicit Turn(std::filesystem::path file)
      : file_(std::move(file)), descriptor_(open(file_.c_str(), O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_RDWR, 0666)) {
    if (descriptor_ >= 0) flock(descriptor_, LOCK_EX);
  }
  ~Turn() {
    if (descriptor_ < 0) return;
    unlink(file_.c_str());
    close(descriptor_);
  }
  Turn(const Turn&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_;
};

}  // namespace

std::vector<double> ReferenceCache::get(const std::string& key,
                                        const std::function<std::vector<double>()>& compute) const {
  if (folder_.empty()) return compute();
  const auto file = folder_ / (digest(key) + ".reference");
  if (auto found = read_numbers(file)) return *std::move(found);
  std::error_code unwritable;
  std::filesystem::create_directories(folder_, unwritable);
  const Turn turn(folder_ / (digest(key) + ".turn"));
  if (auto found = read_numbers(file)) return *std::move(found);
  std::vector<double> values = compute();
  keep_numbers(file, values);
  return values;
}

}  // namespace palpate::study
