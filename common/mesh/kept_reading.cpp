#include "common/mesh/kept_reading.hpp"

#include <gmsh.h>

#include <fstream>
#include <stdexcept>
#include <string_view>

#include "common/describe/digest.hpp"
#include "common/files/atomic_file.hpp"
#include "common/files/user_cache.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

// The number is that of the answer's format (LibraryCalls::read).
constexpr std::string_view kVersion = "palpate reading 1, gmsh " GMSH_API_VERSION "\n";
constexpr std::size_t kDigits = 32, kHead = kVersion.size() + kDigits;
constexpr std::size_t kMaxBytes = 16 << 20;

/// What stands before the answer: an answer at another's place does not fit it.
std::string head_of(const fs::path& place, std::string_view answer) {
  return std::string(kVersion) + digest(place.filename().string() + digest(answer));
}

}  // namespace

fs::path readings_folder(const fs::path& cache) {
  return cache / "readings";
}

std::optional<fs::path> reading_place(const fs::path& mesh_file) {
  const auto cache = user_cache();
  if (!cache) return {};
  return readings_folder(*cache) /
         digest(file_digest(mesh_file) + mesh_file.extension().string() + std::string(kVersion));
}

std::optional<std::string> kept_answer(const fs::path& place) {
  std::error_code error;
  if (!fs::is_regular_file(place, error)) return {};
  const auto size = fs::file_size(place, error);
  if (error || size < kHead || size > kHead + kMaxBytes) return {};
  std::string head(kHead, '\0'), answer(size - kHead, '\0');
  std::ifstream in(place, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  in.read(answer.data(), static_cast<std::streamsize>(answer.size()));
  if (!in || head != head_of(place, answer)) return {};
  return answer;
}

void keep_answer(const fs::path& place, const std::string& answer) {
  if (answer.size() > kMaxBytes) return;
  try {
    make_folder_of(place);
    AtomicFile file(place, kHead + answer.size());
    std::ofstream out(file.handle(), std::ios::binary);
    out << head_of(place, answer) << answer;
    out.close();
    if (out) file.commit();
  } catch (const std::runtime_error&) {
    // The library is asked again next time.
  }
}

}  // namespace palpate
