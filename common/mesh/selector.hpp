#pragma once
#include <fmt/format.h>

#include <string>
#include <vector>

#include "common/describe/description.hpp"

namespace palpate {

/// Selects nodes or elements of a mesh; exactly one member is set in a validated scene.
struct Selector {
  std::vector<int> indices;  ///< 0-based positions in the mesh file's list
  std::optional<Box> box;    ///< nodes inside or on it; elements whose centroid is
  std::string group;         ///< physical group: name or number
};

/// `list`: the key of the indices, `nodes` or `elements`.
inline void describe(Description& d, Selector& s, std::string_view list, Use use = Use::stored) {
  const int given = d.given(list) + d.given("box") + d.given("group");
  d.require(given == 1, "",
            fmt::format("exactly one of '{}', 'box' and 'group' is needed, and there are {}", list, given));
  const bool nodes = list == "nodes";
  d.indices({list, "", nodes ? "node numbers, each once" : "tetrahedron numbers, each once", Need::optional, use},
            s.indices);
  d.box({"box", "m",
         nodes ? "least and greatest corner: the nodes inside or on it" : "the tetrahedra with their centroid inside",
         Need::optional, use},
        s.box);
  d.group({"group", "",
           nodes ? "physical group of the mesh, by name or number: the nodes of its elements"
                 : "physical group of tetrahedra, by name or number",
           Need::optional, use},
          s.group);
}

/// Nodes in a table of their own.
struct NodeSelector : Selector {};
inline void describe(Description& d, NodeSelector& s) {
  describe(d, s, "nodes");
}

/// Elements in a table of their own.
struct ElementSelector : Selector {};
inline void describe(Description& d, ElementSelector& s) {
  describe(d, s, "elements");
}

}  // namespace palpate
