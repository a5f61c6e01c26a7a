#pragma once
#include <cstdint>
#include <map>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "common/mesh/faults.hpp"
#include "common/mesh/file_cursor.hpp"
#include "common/mesh/listing.hpp"

namespace palpate {

struct ElementType {
  int dimension = -1, nodes = 0;
};

/// One of Gmsh's element types; throws where it is not known.
ElementType element_type(int type);

/// Fills a listing: turns the file's node numbers into positions and collects what does not fit.
class Lister {
 public:
  void reserve_nodes(std::size_t count);
  void add_node(std::uint64_t number, const Eigen::Vector3d& x);

  /// Reads the element's nodes from the cursor; `group` 0 is none.
  template <class Integer>
  void add_element(FileCursor& cursor, int type, int entity, int group, std::size_t nodes) {
    ListedElement element{type, entity, {}, {}};
    if (group != 0) element.groups.push_back(group);
    std::uint64_t missing = 0;
    bool complete = true;
    for (std::size_t c = 0; c < nodes; ++c) {
      const auto number = static_cast<std::uint64_t>(cursor.number<Integer>());
      const auto place = positions_.find(number);
      if (place != positions_.end()) {
        element.nodes.push_back(place->second);
      } else {
        complete = false;
        missing = number;
      }
    }
    if (!complete) note_missing(type, missing);
    if (complete && !is_repeated(element)) listing.elements.push_back(std::move(element));
    if (type == 4) ++tetrahedra_;
    ++elements_;
  }

  FileListing listing;
  FaultList faults;

 private:
  void note_missing(int type, std::uint64_t node);
  bool is_repeated(const ListedElement& element);

  std::unordered_map<std::uint64_t, int> positions_;
  std::map<std::vector<int>, std::size_t> with_groups_;
  long tetrahedra_ = 0, elements_ = 0;
};

/// Three coordinates.
template <class Real = double>
Eigen::Vector3d take_point(FileCursor& cursor) {
  const auto x = static_cast<double>(cursor.number<Real>());
  const auto y = static_cast<double>(cursor.number<Real>());
  const auto z = static_cast<double>(cursor.number<Real>());
  return {x, y, z};
}

/// Goes behind the line that opens a section; throws where there is none. `holds`: what it lists.
void expect_section(FileCursor& cursor, std::string_view name, std::string_view holds);

/// Each reads one family of formats from the beginning of the file; throws std::runtime_error(reason).
void list_gmsh(FileCursor& cursor, Lister& lister);
void list_vtk(FileCursor& cursor, Lister& lister);

}  // namespace palpate
