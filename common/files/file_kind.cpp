#include "common/files/file_kind.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <string>

#include "common/describe/byte_order_mark.hpp"

namespace palpate {
namespace {

constexpr std::size_t kRead = 4096;

struct Kind {
  std::string_view ending, words, mark;
  std::size_t at = 0;  ///< of the mark
};
constexpr Kind kKinds[] = {
    {".lcmlog", "a topic log", "\xed\xa1\xda\x01"},
    {".mp4", "a film", "ftyp", 4},
    {".png", "a picture", "\x89PNG"},
    {".mcap", "an MCAP file", "\x89MCAP"},
    {".h5", "an HDF5 file", "\x89HDF"},
    {".msh", "a mesh", "$MeshFormat"},
    {".inr", "an INR image", "#INRIMAGE"},
    {".mha", "a MetaImage", "ObjectType"},
    {".nrrd", "an NRRD image", "NRRD"},
    {".vtu", "XML", "<"},
    {".json", "JSON", "{"},
    {".stl", "a surface", "solid "},
};
constexpr std::string_view kScene = ".toml", kMotion = "motion", kText = ".csv";

bool is_text(std::string_view bytes) {
  return std::ranges::none_of(
      bytes, [](char c) { return static_cast<unsigned char>(c) < 0x20 && !std::strchr("\t\n\f\r", c); });
}

/// Whether the first line that says something names a table or a key.
bool is_toml(std::string_view text) {
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    line.remove_prefix(std::min(line.size(), line.find_first_not_of(" \t\r")));
    if (line.empty() || line[0] == '#') continue;
    const std::size_t key = line.find_first_of("=,;");
    return line[0] == '[' || (key != line.npos && line[key] == '=');
  }
  return false;
}

/// Whether the first line that is no comment names the columns of a trajectory.
bool is_motion(std::string_view text) {
  while (text.starts_with('#')) {
    const std::size_t end = text.find('\n');
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
  }
  return text.starts_with("time,yaw");
}

/// Binary STL has no mark, but says how many triangles of 50 bytes it has.
bool is_binary_stl(std::string_view bytes, std::uintmax_t size) {
  constexpr std::size_t kHead = 80, kTriangle = 50;
  std::uint32_t triangles = 0;
  if (bytes.size() < kHead + sizeof triangles) return false;
  std::memcpy(&triangles, bytes.data() + kHead, sizeof triangles);
  return size == kHead + sizeof triangles + kTriangle * std::uintmax_t{triangles};
}

}  // namespace

std::string_view kind_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes(kRead, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  for (const Kind& kind : kKinds)
    if (bytes.size() >= kind.at && std::string_view(bytes).substr(kind.at).starts_with(kind.mark)) return kind.ending;
  std::error_code unknown;
  if (is_binary_stl(bytes, std::filesystem::file_size(file, unknown))) return ".stl";
  if (bytes.empty() || !is_text(bytes)) return {};
  const std::string_view text = without_byte_order_mark(bytes);
  return is_motion(text) ? kMotion : is_toml(text) ? kScene : kText;
}

std::string_view kind_in_words(std::string_view kind) {
  const auto* known = std::ranges::find(kKinds, kind, &Kind::ending);
  if (known != std::end(kKinds)) return known->words;
  return kind == kScene ? "TOML" : kind == kMotion ? "a trajectory" : kind == kText ? "text" : "something else";
}

}  // namespace palpate
