#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "common/mesh/lister.hpp"

namespace palpate {
namespace {

void expect_end(FileCursor& cursor, std::string_view name) {
  if (cursor.word() != name) throw std::runtime_error(fmt::format("{} is missing after the last entry", name));
}

void list_gmsh1(FileCursor& cursor, Lister& lister) {
  expect_section(cursor, "$NOD", "node list");
  const std::size_t nodes = cursor.text_count("nodes");
  lister.reserve_nodes(nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto number = cursor.number<std::uint64_t>();
    lister.add_node(number, take_point(cursor));
  }
  expect_end(cursor, "$ENDNOD");

  expect_section(cursor, "$ELM", "element list");
  const std::size_t elements = cursor.text_count("elements");
  for (std::size_t i = 0; i < elements; ++i) {
    cursor.number<std::int64_t>();
    const int type = cursor.number<int>(), group = cursor.number<int>(), entity = cursor.number<int>();
    const std::size_t given = cursor.count<int>("nodes of an element");
    if (given != static_cast<std::size_t>(element_type(type).nodes)) {
      throw std::runtime_error(fmt::format("entry {} of the element list has {} nodes, its type {} has {}", i, given,
                                           type, element_type(type).nodes));
    }
    lister.add_element<std::uint64_t>(cursor, type, entity, group, given);
  }
  expect_end(cursor, "$ENDELM");
}

// One element of Gmsh 2 behind its number and type: tags (the group, the entity, others), then nodes.
template <class Integer>
void list_gmsh2_element(FileCursor& cursor, Lister& lister, int type, std::size_t tags) {
  int group = 0, entity = 0;
  for (std::size_t t = 0; t < tags; ++t) {
    const int tag = cursor.number<int>();
    if (t == 0) group = tag;
    if (t == 1) entity = tag;
  }
  lister.add_element<Integer>(cursor, type, entity, group, static_cast<std::size_t>(element_type(type).nodes));
}

void list_gmsh2(FileCursor& cursor, Lister& lister) {
  const bool binary = std::exchange(cursor.binary, false);
  expect_section(cursor, "$Nodes", "node list");
  const std::size_t nodes = cursor.text_count("nodes");
  if (binary) cursor.rest_of_line();
  cursor.binary = binary;
  lister.reserve_nodes(nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto number = binary ? static_cast<std::uint64_t>(cursor.number<int>()) : cursor.number<std::uint64_t>();
    lister.add_node(number, take_point(cursor));
  }
  expect_end(cursor, "$EndNodes");

  expect_section(cursor, "$Elements", "element list");
  const std::size_t elements = cursor.text_count("elements");
  if (binary) cursor.rest_of_line();
  for (std::size_t i = 0; i < elements;) {
    if (!binary) {
      cursor.number<std::int64_t>();
      const int type = cursor.number<int>();
      list_gmsh2_element<std::uint64_t>(cursor, lister, type, cursor.count<int>("tags of an element"));
      ++i;
      continue;
    }
    const int type = cursor.number<int>();
    const std::size_t in_block = cursor.count<int>("elements"), tags = cursor.count<int>("tags of an element");
    if (in_block == 0) throw std::runtime_error("the element list has an empty block");
    for (std::size_t k = 0; k < in_block; ++k, ++i) {
      cursor.number<int>();
      list_gmsh2_element<int>(cursor, lister, type, tags);
    }
  }
  expect_end(cursor, "$EndElements");
}

void list_gmsh4_nodes(FileCursor& cursor, Lister& lister) {
  const std::size_t blocks = cursor.count<std::size_t>("blocks of nodes");
  const std::size_t nodes = cursor.count<std::size_t>("nodes");
  for (int unused = 0; unused < 2; ++unused) cursor.number<std::size_t>();
  lister.reserve_nodes(nodes);
  for (std::size_t b = 0; b < blocks; ++b) {
    const int dimension = cursor.number<int>();
    cursor.number<int>();
    const int parametric = cursor.number<int>();
    std::vector<std::uint64_t> numbers(cursor.count<std::size_t>("nodes"));
    for (auto& number : numbers) number = cursor.number<std::size_t>();
    for (auto number : numbers) {
      lister.add_node(number, take_point(cursor));
      for (int p = 0; parametric != 0 && p < dimension; ++p) cursor.number<double>();
    }
  }
  if (lister.listing.nodes.size() != nodes) {
    throw std::runtime_error(
        fmt::format("the file announces {} nodes and lists {}", nodes, lister.listing.nodes.size()));
  }
}

void list_gmsh4_elements(FileCursor& cursor, Lister& lister) {
  const std::size_t blocks = cursor.count<std::size_t>("blocks of elements");
  for (int unused = 0; unused < 3; ++unused) cursor.number<std::size_t>();
  for (std::size_t b = 0; b < blocks; ++b) {
    cursor.number<int>();
    const int entity = cursor.number<int>(), type = cursor.number<int>();
    const std::size_t count = cursor.count<std::size_t>("elements");
    for (std::size_t k = 0; k < count; ++k) {
      cursor.number<std::size_t>();
      lister.add_element<std::size_t>(cursor, type, entity, 0, static_cast<std::size_t>(element_type(type).nodes));
    }
  }
}

void list_gmsh4(FileCursor& cursor, Lister& lister) {
  lister.listing.groups_by_entity = true;
  expect_section(cursor, "$Nodes", "node list");
  if (cursor.binary) cursor.rest_of_line();
  list_gmsh4_nodes(cursor, lister);
  expect_end(cursor, "$EndNodes");
  expect_section(cursor, "$Elements", "element list");
  if (cursor.binary) cursor.rest_of_line();
  list_gmsh4_elements(cursor, lister);
  expect_end(cursor, "$EndElements");
}

}  // namespace

void list_gmsh(FileCursor& cursor, Lister& lister) {
  if (!cursor.seek_line("$MeshFormat")) return list_gmsh1(cursor, lister);
  const std::string version(cursor.word());
  cursor.binary = cursor.text_number<int>() != 0;
  if (cursor.text_number<int>() != 8) throw std::runtime_error("its real numbers do not have 8 bytes");
  cursor.rest_of_line();
  if (cursor.binary && cursor.number<int>() != 1) {
    throw std::runtime_error("it is binary with the byte order of another machine; save it as text");
  }
  if (version == "2" || version.starts_with("2.")) return list_gmsh2(cursor, lister);
  if (version == "4.1") return list_gmsh4(cursor, lister);
  throw std::runtime_error("Gmsh format " + version.substr(0, 10) + " is not read; save it as 4.1 or 2.2");
}

}  // namespace palpate
