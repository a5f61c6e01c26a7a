#include "tools/study/reference_cache.hpp"

#include <cstdint>
#include <fstream>
#include <optional>

#include "common/describe/digest.hpp"
#include "common/files/atomic_file.hpp"
#include "common/files/file_lock.hpp"

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

}  // namespace

std::vector<double> ReferenceCache::get(const std::string& key,
                                        const std::function<std::vector<double>()>& compute) const {
  if (folder_.empty()) return compute();
  const auto file = folder_ / (digest(key) + ".reference");
  if (auto found = read_numbers(file)) return *std::move(found);
  std::error_code unwritable;
  std::filesystem::create_directories(folder_, unwritable);
  // Other processes wait for it in place of computing it too.
  const auto turn_file = folder_ / (digest(key) + ".turn");
  const FileLock turn = FileLock::wait_for(turn_file);
  if (auto found = read_numbers(file)) return *std::move(found);
  std::vector<double> values = compute();
  keep_numbers(file, values);
  std::filesystem::remove(turn_file, unwritable);
  return values;
}

}  // namespace palpate::study
