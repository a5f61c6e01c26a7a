#include "tools/organ/nifti_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>

namespace palpate {
namespace {

using GzFile = std::unique_ptr<gzFile_s, int (*)(gzFile)>;

constexpr int kFirstSize = 348, kSecondSize = 540;  // [bytes] of the headers of NIfTI-1 and NIfTI-2
constexpr unsigned kChunk = 1 << 16;                // [bytes] that are looked at together

/// What a header says, in either order of bytes.
class NiftiHeader {
 public:
  explicit NiftiHeader(std::string bytes) : bytes_(std::move(bytes)) {
    swapped_ = stored<std::int32_t>(0) != kFirstSize && stored<std::int32_t>(0) != kSecondSize;
    second_ = number<std::int32_t>(0) == kSecondSize;
  }

  bool is_second() const { return second_; }
  bool is_nifti() const { return second_ ? bytes_.compare(4, 2, "n+") == 0 : bytes_.compare(344, 1, "n") == 0; }
  bool holds_its_voxels() const { return bytes_[second_ ? 5 : 345] == '+'; }
  int units() const { return (second_ ? number<std::int32_t>(500) : bytes_[123]) & 7; }

  /// [bytes] To the last voxel; what does not fit is rounded. 0: of values of a kind that is not known.
  double size() const {
    const auto dimensions = static_cast<int>(std::clamp(length(0), 0.0, 7.0));
    double values = 1;
    for (int d = 1; d <= dimensions; ++d) values *= std::max(length(d), 1.0);
    const int bytes = bytes_of_value(number<std::int16_t>(second_ ? 12 : 70));
    return bytes == 0 ? 0 : voxels_at() + values * bytes;
  }

  /// Whether bytes begin as a header of one of both kinds does.
  static bool begins(const std::string& bytes) {
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data(), sizeof size);
    for (const std::uint32_t known : {kFirstSize, kSecondSize})
      if (size == known || size == __builtin_bswap32(known)) return true;
    return false;
  }

 private:
  template <class T>
  T stored(std::size_t at) const {
    T value;
    std::memcpy(&value, bytes_.data() + at, sizeof value);
    return value;
  }
  template <class T>
  T number(std::size_t at) const {
    char raw[sizeof(T)];
    std::memcpy(raw, bytes_.data() + at, sizeof raw);
    if (swapped_) std::reverse(raw, raw + sizeof raw);
    T value;
    std::memcpy(&value, raw, sizeof value);
    return value;
  }
  double length(int d) const {
    return second_ ? static_cast<double>(number<std::int64_t>(16 + 8 * d)) : number<std::int16_t>(40 + 2 * d);
  }
  /// [bytes] Behind the header at least.
  double voxels_at() const {
    const double least = second_ ? kSecondSize : kFirstSize;
    const double told = second_ ? static_cast<double>(number<std::int64_t>(168)) : number<float>(108);
    return told > least ? told : least;  // false for what is no number
  }
  static int bytes_of_value(int kind) {
    switch (kind) {
      case 2:
      case 256:
        return 1;
      case 4:
      case 512:
        return 2;
      case 128:
        return 3;
      case 8:
      case 16:
      case 768:
      case 2304:
        return 4;
      case 32:
      case 64:
      case 1024:
      case 1280:
        return 8;
      case 1536:
      case 1792:
        return 16;
      case 2048:
        return 32;
      default:
        return 0;
    }
  }

  std::string bytes_;
  bool swapped_ = false, second_ = false;
};

/// Up to so many bytes; fewer at the file's end. Throws std::runtime_error where compressed ones are broken.
std::string read_some(gzFile in, unsigned bytes) {
  std::string some(bytes, '\0');
  const int count = gzread(in, some.data(), bytes);
  int fault = Z_OK;
  gzerror(in, &fault);
  if (count < 0 || (fault != Z_OK && fault != Z_BUF_ERROR)) throw std::runtime_error("its compressed bytes are broken");
  if (fault == Z_BUF_ERROR)
    throw std::runtime_error("it ends before its last voxel: its compressed bytes are cut short");
  some.resize(count);
  return some;
}

void check_units(int units) {
  if (units != 1 && units != 3) return;
  throw std::runtime_error(
      fmt::format("its lengths are in {}, and images in millimetres are read: write it in these, its spacing and its "
                  "origin",
                  units == 1 ? "metres" : "micrometres"));
}

}  // namespace

void check_nifti_file(const std::string& file) {
  const GzFile in(gzopen(file.c_str(), "rb"), gzclose);
  if (!in) throw std::runtime_error("it cannot be opened");
  std::string bytes = read_some(in.get(), kFirstSize);
  if (bytes.size() < 4 || !NiftiHeader::begins(bytes)) return;
  constexpr const char* kCutHeader = "it ends within its header";
  if (bytes.size() < kFirstSize) throw std::runtime_error(kCutHeader);
  if (NiftiHeader(bytes).is_second()) bytes += read_some(in.get(), kSecondSize - kFirstSize);
  const NiftiHeader header(bytes);
  if (header.is_second() && bytes.size() < kSecondSize) throw std::runtime_error(kCutHeader);
  if (!header.is_nifti()) return;
  check_units(header.units());
  if (!header.holds_its_voxels()) throw std::runtime_error("its voxels are in another file, and a single one is read");
  // A little more is read than it needs, so that the end of compressed bytes is looked at, and no more.
  auto count = static_cast<double>(bytes.size());
  for (std::size_t more = 1; more > 0 && count <= header.size() + kChunk; count += static_cast<double>(more))
    more = read_some(in.get(), kChunk).size();
  if (count < header.size()) throw std::runtime_error("it ends before its last voxel");
}

}  // namespace palpate
