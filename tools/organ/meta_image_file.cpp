#include "tools/organ/meta_image_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <stdexcept>
#include <vector>

namespace palpate {
namespace {

constexpr std::size_t kLongestLine = 1 << 16, kMostLines = 10000;
constexpr std::size_t kChunk = 1 << 16;  // [bytes] that are inflated together

struct MetaHeader {
  std::map<std::string, std::string> value;  ///< of each key
  std::int64_t end = 0;                      ///< [bytes] where voxels begin that are in the same file

  std::string of(const std::string& key) const {
    const auto found = value.find(key);
    return found == value.end() ? "" : found->second;
  }
  bool is(const std::string& key) const {  // as ITK reads a word
    const std::string word = of(key);
    return !word.empty() && std::string("Tt1").find(word[0]) != std::string::npos;
  }
};

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// Its lines "KEY = VALUE" up to that of the voxels' file, or as far as they are lines.
MetaHeader read_meta_header(std::istream& in) {
  MetaHeader header;
  std::string line(kLongestLine, '\0');
  for (std::size_t n = 0; n < kMostLines && in.getline(line.data(), static_cast<std::streamsize>(line.size())); ++n) {
    const std::string text = line.substr(0, line.find('\0'));
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) continue;
    const std::string key = trimmed(text.substr(0, equals));
    header.value[key] = trimmed(text.substr(equals + 1));
    if (key != "ElementDataFile") continue;
    header.end = in.tellg();
    break;
  }
  return header;
}

std::ifstream open_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(fmt::format("its file {} cannot be opened", file.filename().string()));
  return in;
}

std::int64_t size_of(const std::filesystem::path& file) {
  return static_cast<std::int64_t>(std::filesystem::file_size(file));
}

/// Of zlib's format or gzip's.
class Inflater {
 public:
  Inflater() {
    constexpr int kEitherKind = 15 + 32;
    if (inflateInit2(&stream_, kEitherKind) != Z_OK) throw std::runtime_error("there is no memory to inflate it");
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;

  bool has_ended() const { return ended_; }
  /// How many bytes come of these.
  std::int64_t count(std::vector<char>& packed, std::size_t size) {
    std::vector<char> room(kChunk);
    std::int64_t inflated = 0;
    stream_.next_in = reinterpret_cast<Bytef*>(packed.data());
    stream_.avail_in = static_cast<uInt>(size);
    do {
      stream_.next_out = reinterpret_cast<Bytef*>(room.data());
      stream_.avail_out = static_cast<uInt>(room.size());
      const int state = inflate(&stream_, Z_NO_FLUSH);
      if (state != Z_OK && state != Z_STREAM_END && state != Z_BUF_ERROR)
        throw std::runtime_error("its compressed bytes are broken");
      ended_ = state == Z_STREAM_END;
      inflated += static_cast<std::int64_t>(room.size() - stream_.avail_out);
    } while (!ended_ && stream_.avail_out == 0);
    return inflated;
  }

 private:
  z_stream stream_{};
  bool ended_ = false;
};

/// Whether so many bytes come of the next `size` ones, which are compressed, and these end.
bool inflates_to(std::istream& in, std::int64_t size, std::int64_t bytes) {
  Inflater inflater;
  std::vector<char> packed(kChunk);
  std::int64_t inflated = 0;
  while (!inflater.has_ended() && inflated <= bytes) {
    in.read(packed.data(), std::min<std::int64_t>(size, packed.size()));
    if (in.gcount() == 0) return false;
    size -= in.gcount();
    inflated += inflater.count(packed, static_cast<std::size_t>(in.gcount()));
  }
  return inflated >= bytes;
}

/// [bytes] Of compressed voxels; all that follow where the header does not say it.
std::int64_t packed_size(const MetaHeader& header) {
  const double told = std::strtod(header.of("CompressedDataSize").c_str(), nullptr);
  constexpr auto kAll = std::numeric_limits<std::int64_t>::max();
  return told > 0 && told < 1e18 ? static_cast<std::int64_t>(told) : kAll;
}

}  // namespace

void check_meta_image_axes(const std::string& file) {
  std::ifstream in = open_file(file);
  const std::string axes = read_meta_header(in).of("NDims");
  if (!axes.empty() && axes != "2" && axes != "3")
    throw std::runtime_error(fmt::format("it has {} axes, where 2 or 3 are read", axes));
}

bool holds_all_voxels(const std::string& file, std::int64_t bytes) {
  std::ifstream in = open_file(file);
  const MetaHeader header = read_meta_header(in);
  const std::string data = header.of("ElementDataFile");
  const bool packed = header.is("CompressedData");
  if (data == "LOCAL" || data == "Local" || data == "local") {
    if (!packed) return size_of(file) - header.end >= bytes;
    if (header.of("CompressedDataSize").empty())
      throw std::runtime_error(
          "its header lacks CompressedDataSize, without which ITK takes other bytes for its voxels");
    return inflates_to(in, packed_size(header), bytes);
  }
  const bool is_one = data.find('%') == std::string::npos && !data.starts_with("LIST");
  if (!is_one || !header.is("BinaryData")) return true;
  const std::filesystem::path other = std::filesystem::path(file).parent_path() / data;
  std::ifstream beside = open_file(other);
  if (packed) return inflates_to(beside, packed_size(header), bytes);
  const double before = std::max(0.0, std::strtod(header.of("HeaderSize").c_str(), nullptr));
  return static_cast<double>(size_of(other)) - before >= static_cast<double>(bytes);
}

}  // namespace palpate
