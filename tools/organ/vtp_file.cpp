#include "tools/organ/vtp_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <cstring>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

#include "common/mesh/file_cursor.hpp"

namespace palpate {
namespace {

constexpr std::size_t kMaxArray = std::size_t{4} << 30;  // [bytes]

/// Stands at a tag; `name` is empty past the last one.
struct Tag {
  std::string_view name;
  std::map<std::string_view, std::string_view> values;
  std::size_t end = 0;  ///< behind its '>'
};

Tag read_tag(std::string_view text, std::size_t from) {
  Tag tag;
  const std::size_t begin = text.find('<', from), end = text.find('>', begin);
  if (begin == std::string_view::npos || end == std::string_view::npos) return tag;
  std::string_view inside = text.substr(begin + 1, end - begin - 1);
  tag.end = end + 1;
  tag.name = inside.substr(0, inside.find_first_of(" \t\r\n/", 1));
  for (std::size_t at; (at = inside.find('=')) != std::string_view::npos;) {
    const std::string_view before = inside.substr(0, at);
    const std::size_t name = before.find_last_of(" \t\r\n");
    if (at + 1 >= inside.size()) break;
    const std::size_t close = inside.find(inside[at + 1], at + 2);
    if (name == std::string_view::npos || close == std::string_view::npos) break;
    tag.values[before.substr(name + 1)] = inside.substr(at + 2, close - at - 2);
    inside.remove_prefix(close + 1);
  }
  return tag;
}

int base64_digit(char c) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t place = kDigits.find(c);
  return place == std::string_view::npos ? -1 : static_cast<int>(place);
}

/// Takes bytes from base64 until `count` have come or the text is no base64 any more; whole groups of four.
std::string take_base64(std::string_view& text, std::size_t count) {
  std::string bytes;
  while (bytes.size() < count) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    if (text.size() < 4) throw std::runtime_error("an array ends too early");
    std::uint32_t group = 0;
    int digits = 0;
    for (int i = 0; i < 4; ++i) {
      const int digit = base64_digit(text[i]);
      digits += digit >= 0;
      group = group << 6 | static_cast<std::uint32_t>(std::max(digit, 0));
    }
    if (digits < 2) throw std::runtime_error("an array is not in base64");
    for (int i = 0; i + 1 < digits; ++i) bytes += static_cast<char>(group >> (16 - 8 * i));
    text.remove_prefix(4);
  }
  bytes.resize(count);
  return bytes;
}

/// What the file says of all its arrays.
struct Encoding {
  bool swapped = false, compressed = false, base64 = true;
  std::size_t header_size = 4;
  std::string_view appended;
};

std::size_t whole_number(const std::string& bytes, std::size_t place, const Encoding& e) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < e.header_size; ++i) {
    const std::size_t digit = e.swapped ? i : e.header_size - 1 - i;
    number = number << 8 | static_cast<unsigned char>(bytes[place * e.header_size + digit]);
  }
  if (number > kMaxArray) throw std::runtime_error("an array is larger than any surface's");
  return number;
}

std::string take_bytes(std::string_view& text, std::size_t count, bool base64) {
  if (base64) return take_base64(text, count);
  if (text.size() < count) throw std::runtime_error("an array ends too early");
  std::string bytes(text.substr(0, count));
  text.remove_prefix(count);
  return bytes;
}

std::string uncompress_block(const std::string& bytes, std::size_t size) {
  // zlib packs a thousand bytes into one at best.
  if (size / 1100 > bytes.size()) throw std::runtime_error("a compressed block announces more than it can hold");
  std::string block(size, '\0');
  uLongf got = size;
  if (uncompress(reinterpret_cast<Bytef*>(block.data()), &got, reinterpret_cast<const Bytef*>(bytes.data()),
                 bytes.size()) != Z_OK ||
      got != size)
    throw std::runtime_error("a compressed block is damaged");
  return block;
}

std::string take_array(std::string_view text, const Encoding& e, bool base64) {
  if (!e.compressed) {
    // The length and the numbers are one piece of base64.
    std::string_view ahead = text;
    const std::size_t size = whole_number(take_bytes(ahead, e.header_size, base64), 0, e);
    if (size > text.size()) throw std::runtime_error("an array ends too early");
    return take_bytes(text, e.header_size + size, base64).substr(e.header_size);
  }
  std::string_view ahead = text;
  const std::size_t blocks = whole_number(take_bytes(ahead, e.header_size, base64), 0, e);
  if (blocks > text.size()) throw std::runtime_error("an array ends too early");
  const std::string head = take_bytes(text, (3 + blocks) * e.header_size, base64);
  const std::size_t full = whole_number(head, 1, e), last = whole_number(head, 2, e);
  std::size_t packed = 0;
  for (std::size_t b = 0; b < blocks; ++b) packed += whole_number(head, 3 + b, e);
  if (packed > text.size()) throw std::runtime_error("an array ends too early");
  const std::string bytes = take_bytes(text, packed, base64);
  std::string array;
  for (std::size_t b = 0, at = 0; b < blocks; ++b) {
    const std::size_t size = whole_number(head, 3 + b, e);
    array += uncompress_block(bytes.substr(at, size), b + 1 == blocks && last > 0 ? last : full);
    at += size;
  }
  return array;
}

template <class T>
std::vector<double> numbers_as(FileCursor cursor, std::size_t size) {
  std::vector<double> numbers(size / sizeof(T));
  for (double& number : numbers) number = static_cast<double>(cursor.number<T>());
  return numbers;
}

/// The numbers of the DataArray `tag`.
std::vector<double> read_numbers(std::string_view text, const Tag& tag, const Encoding& e) {
  const auto value = [&](const char* name) { return tag.values.contains(name) ? tag.values.at(name) : ""; };
  const std::string_view format = value("format"), type = value("type");
  const std::string_view inside = text.substr(tag.end, text.find('<', tag.end) - tag.end);
  if (format == "ascii") {
    std::vector<double> numbers;
    FileCursor cursor(inside.substr(0, inside.find_last_not_of(" \t\r\n") + 1));
    while (cursor.left() > 0) numbers.push_back(cursor.text_number<double>());
    return numbers;
  }
  std::string array;
  if (format == "appended") {
    const auto offset = FileCursor(value("offset")).text_number<std::size_t>();
    if (offset >= e.appended.size()) throw std::runtime_error("an array begins behind the end of the file");
    array = take_array(e.appended.substr(offset), e, e.base64);
  } else {
    array = take_array(inside, e, true);
  }
  FileCursor cursor(array);
  cursor.binary = true;
  cursor.swapped = e.swapped;
  if (type == "Float32") return numbers_as<float>(cursor, array.size());
  if (type == "Float64") return numbers_as<double>(cursor, array.size());
  if (type == "Int32") return numbers_as<std::int32_t>(cursor, array.size());
  if (type == "Int64") return numbers_as<std::int64_t>(cursor, array.size());
  throw std::runtime_error(fmt::format("an array's type is '{}': Float32, Float64, Int32 and Int64 are read", type));
}

Encoding encoding_of(std::string_view text, const Tag& file) {
  const auto value = [&](const char* name) { return file.values.contains(name) ? file.values.at(name) : ""; };
  Encoding e;
  e.swapped = value("byte_order") == "BigEndian";
  e.header_size = value("header_type") == "UInt64" ? 8 : 4;
  e.compressed = !value("compressor").empty();
  if (e.compressed && value("compressor") != "vtkZLibDataCompressor")
    throw std::runtime_error(fmt::format("it is compressed by {}; that of zlib is read", value("compressor")));
  if (const std::size_t begin = text.find("<AppendedData"); begin != std::string_view::npos) {
    const Tag tag = read_tag(text, begin);
    e.base64 = !tag.values.contains("encoding") || tag.values.at("encoding") != "raw";
    const std::size_t mark = text.find('_', tag.end);
    if (mark != std::string_view::npos) e.appended = text.substr(mark + 1);
  }
  return e;
}

/// Adds the polygons, or the triangles of the strips, that connectivity and offsets say.
void add_cells(const std::vector<double>& corners, const std::vector<double>& ends, bool strips, Polygons& surface) {
  const auto node = [&](std::size_t i) {
    const double n = corners[i];
    if (!(n >= 0 && n < static_cast<double>(surface.points.size())))
      throw std::runtime_error("a polygon names a point that is not there");
    return static_cast<int>(n);
  };
  std::size_t begin = 0;
  for (const double end : ends) {
    if (!(end >= static_cast<double>(begin) && end <= static_cast<double>(corners.size())))
      throw std::runtime_error("the polygons' offsets do not go up, or beyond the last corner");
    std::vector<int> polygon;
    for (; begin < static_cast<std::size_t>(end); ++begin) polygon.push_back(node(begin));
    strips ? surface.add_strip(polygon) : surface.polygons.push_back(polygon);
  }
}

}  // namespace

Polygons read_vtp(std::string_view text) {
  const std::size_t start = text.find("<VTKFile");
  if (start == std::string_view::npos) throw std::runtime_error("it does not begin as a VTP file does, with <VTKFile");
  Tag tag = read_tag(text, start);
  if (!tag.values.contains("type") || tag.values.at("type") != "PolyData")
    throw std::runtime_error("it holds no PolyData");
  const Encoding encoding = encoding_of(text, tag);
  Polygons surface;
  std::string_view section;
  std::map<std::string, std::vector<double>> arrays;
  int pieces = 0;
  for (; !tag.name.empty() && tag.name != "AppendedData"; tag = read_tag(text, tag.end)) {
    if (tag.name == "Piece" && ++pieces > 1) throw std::runtime_error("it has more than one piece; one is read");
    if (tag.name == "Points" || tag.name == "Polys" || tag.name == "Strips") section = tag.name;
    if (tag.name.starts_with('/') && tag.name.substr(1) == section) section = {};
    if (tag.name != "DataArray" || section.empty()) continue;
    const auto name = tag.values.contains("Name") ? tag.values.at("Name") : "";
    arrays[section == "Points" ? "points" : fmt::format("{} {}", section, name)] = read_numbers(text, tag, encoding);
  }
  const std::vector<double>& places = arrays["points"];
  for (std::size_t i = 0; i + 2 < places.size(); i += 3)
    surface.points.emplace_back(places[i], places[i + 1], places[i + 2]);
  add_cells(arrays["Polys connectivity"], arrays["Polys offsets"], false, surface);
  add_cells(arrays["Strips connectivity"], arrays["Strips offsets"], true, surface);
  return surface;
}

}  // namespace palpate
