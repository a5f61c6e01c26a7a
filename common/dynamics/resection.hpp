#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/describe/description.hpp"
#include "common/dynamics/elastic_mesh.hpp"

namespace palpate {

/// Counts what is cut of a body of moving tissue: of what is marked to be cut off, and of the rest, which is to stay.
class Resection {
 public:
  struct Part {
    std::uint64_t tetrahedra = 0;
    double volume = 0;  ///< [m^3] at rest
  };

  /// Marked are the tetrahedra of the mesh whose centroid at rest is inside the box.
  Resection(const Box& marked, const ElasticMesh& mesh);

  void cut(std::span<const int> tetrahedra);            ///< by their numbers in the mesh
  void cut(std::span<const std::uint32_t> tetrahedra);  ///< from outside: what is no such number is left out

  const Part& inside() const { return inside_; }
  const Part& outside() const { return outside_; }

 private:
  void cut(std::size_t tetrahedron);

  std::vector<char> marked_;
  std::vector<double> volume_;
  Part inside_, outside_;
};

}  // namespace palpate
