#include "common/mesh/lister.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace palpate {
namespace {

// Gmsh's numbering of element types, 1..31.
constexpr ElementType kTypes[] = {{},      {1, 2},  {2, 3},  {2, 4},  {3, 4},  {3, 8},  {3, 6},  {3, 5},
                                  {1, 3},  {2, 6},  {2, 9},  {3, 10}, {3, 27}, {3, 18}, {3, 14}, {0, 1},
                                  {2, 8},  {3, 20}, {3, 15}, {3, 13}, {2, 9},  {2, 10}, {2, 12}, {2, 15},
                                  {2, 15}, {2, 21}, {1, 4},  {1, 5},  {1, 6},  {3, 20}, {3, 35}, {3, 56}};

bool is_known(int type) {
  return type >= 1 && type < static_cast<int>(std::size(kTypes));
}

}  // namespace

ElementType element_type(int type) {
  if (!is_known(type)) throw std::runtime_error(fmt::format("element type {} is not known", type));
  return kTypes[type];
}

int element_dimension(int type) {
  return is_known(type) ? kTypes[type].dimension : -1;
}

void Lister::reserve_nodes(std::size_t count) {
  if (count > static_cast<std::size_t>(std::numeric_limits<int>::max())) throw std::runtime_error("too many nodes");
  listing.nodes.reserve(count);
  listing.node_numbers.reserve(count);
  positions_.reserve(count);
}

void Lister::add_node(std::uint64_t number, const Eigen::Vector3d& x) {
  if (!positions_.emplace(number, static_cast<int>(listing.nodes.size())).second) {
    throw std::runtime_error(fmt::format("node number {} stands twice in the node list", number));
  }
  listing.node_numbers.push_back(number);
  listing.nodes.push_back(x);
}

void Lister::note_missing(int type, std::uint64_t node) {
  const std::string who =
      type == 4 ? fmt::format("element {}", tetrahedra_) : fmt::format("entry {} of the element list", elements_);
  faults.add(fmt::format("{}: node number {} is not in the node list", who, static_cast<std::int64_t>(node)));
}

// Gmsh 1 and 2 write an element once for each of its groups.
bool Lister::is_repeated(const ListedElement& element) {
  if (element.groups.empty()) return false;
  std::vector<int> key = element.nodes;
  key.push_back(element.type);
  key.push_back(element.entity);
  const auto [place, is_new] = with_groups_.emplace(std::move(key), listing.elements.size());
  if (is_new) return false;
  auto& groups = listing.elements[place->second].groups;
  if (std::find(groups.begin(), groups.end(), element.groups[0]) != groups.end()) return false;
  groups.push_back(element.groups[0]);
  return true;
}

void expect_section(FileCursor& cursor, std::string_view name, std::string_view holds) {
  if (!cursor.seek_line(name)) throw std::runtime_error(fmt::format("the file has no {} ({})", holds, name));
}

}  // namespace palpate
