#include "tools/organ/ply_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

#include "common/describe/printable.hpp"
#include "common/mesh/file_cursor.hpp"
#include "tools/organ/word_lines.hpp"

namespace palpate {
namespace {

using Take = double (*)(FileCursor&);

template <class T>
double take_as(FileCursor& cursor) {
  return static_cast<double>(cursor.number<T>());
}

/// As text a byte is a number too, and not a letter.
template <class Byte>
double take_byte(FileCursor& cursor) {
  return cursor.binary ? take_as<Byte>(cursor) : cursor.text_number<double>();
}

const std::map<std::string_view, Take> kTypes{
    {"char", take_byte<signed char>},    {"int8", take_byte<signed char>},   {"uchar", take_byte<unsigned char>},
    {"uint8", take_byte<unsigned char>}, {"short", take_as<std::int16_t>},   {"int16", take_as<std::int16_t>},
    {"ushort", take_as<std::uint16_t>},  {"uint16", take_as<std::uint16_t>}, {"int", take_as<std::int32_t>},
    {"int32", take_as<std::int32_t>},    {"uint", take_as<std::uint32_t>},   {"uint32", take_as<std::uint32_t>},
    {"float", take_as<float>},           {"float32", take_as<float>},        {"double", take_as<double>},
    {"float64", take_as<double>}};

struct Property {
  std::string name;
  Take count = nullptr;  ///< of a list
  Take number = nullptr;
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  bool binary = false, swapped = false;
  std::vector<Element> elements;
};

Take type_of(WordLines& lines) {
  const std::string_view word = lines.word();
  const auto type = kTypes.find(word);
  if (type == kTypes.end())
    lines.refuse(fmt::format("\"{}\" is no type of a PLY file's numbers", printable(word.substr(0, 20))));
  return type->second;
}

void take_format(WordLines& lines, Header& header) {
  const std::string_view format = lines.word();
  if (format != "ascii" && format != "binary_little_endian" && format != "binary_big_endian")
    lines.refuse(fmt::format("\"{}\" is no format of PLY files", printable(format.substr(0, 30))));
  header.binary = format != "ascii";
  header.swapped = format == "binary_big_endian";
}

void take_property(WordLines& lines, Header& header) {
  if (header.elements.empty()) lines.refuse("a property stands above all elements");
  WordLines ahead = lines;
  Property property;
  if (ahead.word() == "list") {
    lines.word();
    property.count = type_of(lines);
  }
  property.number = type_of(lines);
  property.name = lines.word();
  header.elements.back().properties.push_back(property);
}

void take_element(WordLines& lines, std::size_t bytes, Header& header) {
  Element element{std::string(lines.word()), 0, {}};
  const double count = lines.number();
  if (!(count >= 0 && count <= static_cast<double>(bytes) && std::floor(count) == count))
    lines.refuse(fmt::format("{} elements are announced, which the file is too short to hold", count));
  element.count = static_cast<std::size_t>(count);
  header.elements.push_back(element);
}

/// Of a text that ends behind its header's last line.
Header read_header(std::string_view text, std::size_t bytes) {
  Header header;
  for (WordLines lines(text); lines.next();) {
    const std::string_view key = lines.word();
    if (key == "format") take_format(lines, header);
    if (key == "element") take_element(lines, bytes, header);
    if (key == "property") take_property(lines, header);
  }
  return header;
}

std::vector<double> take_values(FileCursor& cursor, const Property& property) {
  std::size_t count = 1;
  if (property.count) {
    const double announced = property.count(cursor);
    if (!(announced >= 0 && announced <= static_cast<double>(cursor.left())))
      throw std::runtime_error(fmt::format("a list of {} entries, which the file is too short to hold", announced));
    count = static_cast<std::size_t>(announced);
  }
  std::vector<double> values;
  for (; count > 0; --count) values.push_back(property.number(cursor));
  return values;
}

bool is_corners(const Property& p) {
  return p.count && (p.name == "vertex_indices" || p.name == "vertex_index");
}

void take_vertex(FileCursor& cursor, const Element& vertex, Polygons& read) {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (const Property& p : vertex.properties) {
    const std::vector<double> values = take_values(cursor, p);
    if (!p.count && p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z') place[p.name[0] - 'x'] = values[0];
  }
  read.points.push_back(place);
}

void take_face(FileCursor& cursor, const Element& face, Polygons& read) {
  for (const Property& p : face.properties) {
    const std::vector<double> values = take_values(cursor, p);
    if (!is_corners(p)) continue;
    std::vector<int>& polygon = read.polygons.emplace_back();
    for (const double n : values) {
      if (!(n >= 0 && n < 2e9)) throw std::runtime_error(fmt::format("a corner is vertex {}", n));
      polygon.push_back(static_cast<int>(n));
    }
  }
}

void take_other(FileCursor& cursor, const Element& element) {
  for (const Property& p : element.properties) take_values(cursor, p);
}

void take_elements(FileCursor& cursor, const Element& element, Polygons& read) {
  std::size_t i = 0;
  try {
    for (; i < element.count; ++i)
      if (element.name == "vertex")
        take_vertex(cursor, element, read);
      else if (element.name == "face")
        take_face(cursor, element, read);
      else
        take_other(cursor, element);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{} {} of {}: {}", printable(element.name), i, element.count, error.what()));
  }
}

/// Before much is read.
void check_header(const Header& header) {
  const auto has = [&](const char* element, const auto& property) {
    return std::ranges::any_of(header.elements, [&](const Element& e) {
      return e.name == element && std::ranges::any_of(e.properties, property);
    });
  };
  for (const std::string name : {"x", "y", "z"})
    if (!has("vertex", [&](const Property& p) { return p.name == name && !p.count; }))
      throw std::runtime_error(fmt::format("its header has no vertices with a coordinate {}", name));
  if (!has("face", is_corners))
    throw std::runtime_error("its header has no faces with a list of vertex_indices: strips and points are not read");
  for (const Element& e : header.elements)
    if (e.properties.empty() && e.count > 0)
      throw std::runtime_error(fmt::format("its header gives the element '{}' no property", printable(e.name)));
}

}  // namespace

Polygons read_ply(std::string_view bytes) {
  FileCursor cursor(bytes);
  if (cursor.rest_of_line() != "ply") throw std::runtime_error("it does not begin as a PLY file does, with ply");
  if (!cursor.seek_line("end_header")) throw std::runtime_error("it has no end_header: it is cut short or no PLY file");
  const Header header = read_header(bytes.substr(0, bytes.size() - cursor.left()), bytes.size());
  check_header(header);
  cursor.rest_of_line();
  cursor.binary = header.binary;
  cursor.swapped = header.swapped;
  Polygons read;
  for (const Element& element : header.elements) take_elements(cursor, element, read);
  for (std::size_t f = 0; f < read.polygons.size(); ++f)
    for (const int n : read.polygons[f])
      if (static_cast<std::size_t>(n) >= read.points.size())
        throw std::runtime_error(fmt::format("face {} names vertex {}, of {}", f, n, read.points.size()));
  return read;
}

}  // namespace palpate
