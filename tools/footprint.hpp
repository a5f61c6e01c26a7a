#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/scene/scene.hpp"

namespace palpate {

/// A part of the run time and the memory it takes.
struct MemoryPart {
  std::string owner;  ///< the program, or "disk"
  std::string what;
  std::size_t bytes;
};

/// Free degrees of freedom of the touchable and of the other visible nodes.
struct DofCounts {
  std::size_t touchable = 0, other = 0;
};
DofCounts count_dofs(const SurfaceMap& surface);

/// What one body takes, computed by the classes that take it or by their own formulas. `elements`: entries of
/// the material field, 0 with one material.
std::vector<MemoryPart> body_memory(const Scene& scene, const Body& body, const SurfaceMap& surface,
                                    std::size_t elements);

/// What is legal but likely not meant: a tip smaller than the elements, locking, a scale that is off.
std::vector<std::string> body_warnings(const Scene& scene, const Body& body, const SurfaceMap& surface);

}  // namespace palpate
