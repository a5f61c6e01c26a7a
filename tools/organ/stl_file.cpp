#include "tools/organ/stl_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "common/mesh/file_cursor.hpp"

namespace palpate {
namespace {

char small_letter(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

constexpr std::size_t kHeader = 84, kOfTriangle = 50;

void add_triangle(TriangleMesh& mesh, const std::array<Eigen::Vector3d, 3>& corners) {
  const int first = static_cast<int>(mesh.nodes.size());
  mesh.nodes.insert(mesh.nodes.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
}

std::size_t announced(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHeader - sizeof count, sizeof count);
  return count;
}

ReadSurface read_binary(std::string_view bytes) {
  ReadSurface surface;
  const std::size_t count = (bytes.size() - kHeader) / kOfTriangle, told = announced(bytes);
  if (bytes.starts_with("solid"))
    surface.findings.push_back({"a binary file whose first line is that of a text file", "", {}});
  if (told != count)
    surface.findings.push_back({fmt::format("its header announces {} triangles and the file holds {}{}", told, count,
                                            (bytes.size() - kHeader) % kOfTriangle == 0 ? "" : " and a part of one"),
                                "what it holds is taken",
                                {}});
  for (std::size_t t = 0; t < count; ++t) {
    std::array<float, 12> numbers;
    std::memcpy(numbers.data(), bytes.data() + kHeader + t * kOfTriangle, sizeof numbers);
    std::array<Eigen::Vector3d, 3> corners;
    for (int c = 0; c < 3; ++c) corners[c] = Eigen::Vector3f(numbers.data() + 3 + 3 * c).cast<double>();
    add_triangle(surface.mesh, corners);
  }
  return surface;
}

/// In small letters: keywords may be written in either.
std::string keyword(FileCursor& cursor) {
  std::string word(cursor.word());
  std::ranges::transform(word, word.begin(), small_letter);
  return word;
}

/// Where a word stands, in letters of either kind.
std::size_t find_word(std::string_view bytes, std::string_view word) {
  const auto same = [](char a, char b) { return small_letter(a) == b; };
  const auto found = std::search(bytes.begin(), bytes.end(), word.begin(), word.end(), same);
  return found == bytes.end() ? std::string_view::npos : static_cast<std::size_t>(found - bytes.begin());
}

/// Goes behind the next "loop"; false where the file ends before one. Names may be anything.
bool find_loop(FileCursor& cursor) {
  while (cursor.left() > 0) {
    const std::string word = keyword(cursor);
    if (word == "loop") return true;
    if (word == "solid" || word == "endsolid") cursor.rest_of_line();
  }
  return false;
}

std::array<Eigen::Vector3d, 3> take_corners(FileCursor& cursor) {
  std::array<Eigen::Vector3d, 3> corners;
  for (Eigen::Vector3d& corner : corners) {
    if (keyword(cursor) != "vertex") throw std::runtime_error("it has not three corners");
    for (int i = 0; i < 3; ++i) corner[i] = cursor.text_number<double>();
  }
  if (keyword(cursor) != "endloop") throw std::runtime_error("it has more than three corners, or no end");
  return corners;
}

ReadSurface read_text(std::string_view bytes) {
  ReadSurface surface;
  FileCursor cursor(bytes.substr(0, bytes.find_last_not_of(" \t\r\n") + 1));
  while (find_loop(cursor)) try {
      add_triangle(surface.mesh, take_corners(cursor));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("triangle {}: {}", surface.mesh.triangles.size(), error.what()));
    }
  return surface;
}

}  // namespace

ReadSurface read_stl(std::string_view bytes) {
  const bool exact = bytes.size() >= kHeader && bytes.size() == kHeader + kOfTriangle * announced(bytes);
  const std::size_t facet = find_word(bytes, "facet");
  const bool text = facet != std::string_view::npos && bytes.substr(0, facet).find('\0') == std::string_view::npos &&
                    find_word(bytes.substr(facet), "vertex") != std::string_view::npos;
  if (!exact && text) return read_text(bytes);
  if (bytes.size() < kHeader + kOfTriangle) throw std::runtime_error("it is too short for an STL file with a triangle");
  return read_binary(bytes);
}

}  // namespace palpate
