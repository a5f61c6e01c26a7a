#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace palpate {

/// Elements of one type and one set of groups, as gmsh keeps them.
struct LibraryEntity {
  int dimension, number;
  int element_type;                ///< gmsh's number
  std::vector<std::size_t> nodes;  ///< of its elements one after another, by number
};

/// A named group of entities of one dimension.
struct LibraryGroup {
  int dimension, number;
  std::vector<int> entities;
  std::string name;
};

/// A mesh as gmsh takes it; the first entity gets the nodes.
struct LibraryModel {
  std::vector<std::size_t> node_numbers;
  std::vector<double> coordinates;  ///< [mesh units] x, y, z of each node
  std::vector<LibraryEntity> entities;
  std::vector<LibraryGroup> groups;
};

struct LibraryFormat {
  double version;  ///< of .msh
  bool binary;
  bool by_group;  ///< only what belongs to a group is saved
};

/// What is asked of gmsh. Each is for a process of its own (child.hpp), and throws std::exception or std::string.
struct LibraryCalls {
  /// Nodes' numbers and coordinates, tetrahedra, triangles, number of groups; of each group dimension, number, name
  /// and entities, as put() and put_all() write them.
  std::string (*read)(const std::string& file);
  std::string (*write)(const LibraryModel& model, const std::string& file, const LibraryFormat& format);
  /// Nodes' numbers and coordinates, tetrahedra. `size` [mesh units]: of edges, at most.
  std::string (*fill)(const LibraryModel& surface, double size);
};

}  // namespace palpate

/// What libpalpate_gmsh.so is loaded for.
extern "C" const palpate::LibraryCalls* palpate_gmsh_calls();
