#pragma once
#include <cstddef>
#include <filesystem>
#include <string>

#include "common/scene/scene.hpp"

namespace palpate {

/// XXH3-128, as 32 hexadecimal digits, over everything that changes a number in the archive of a body: the
/// bytes of the mesh file and its scale, Young's modulus and Poisson's ratio of the body and of its regions,
/// fixations, touchable set, specimen mesh, and the format version; where the body moves with inertia its model and
/// densities too, of a hybrid its regions, its second mesh and gravity, and of a shell its density, thickness, bending
/// element, number of modes and held rotations. Of a catheter, whose rest shape follows from the scene alone, it covers
/// that shape. It reads the mesh file but does not parse it, so that every node finds its archive without a mesh
/// library. Throws std::runtime_error if a file cannot be read.
std::string content_hash(const Body& body);

/// XXH3-128 of a block of memory.
std::string checksum(const void* data, std::size_t bytes);

}  // namespace palpate
