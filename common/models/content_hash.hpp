#pragma once
#include <string>

#include "common/models/body.hpp"

namespace palpate {

/// Hash (XXH3, 128 bits, 32 hexadecimal digits) of everything that an archive's numbers depend on: what the specs call
/// stored, the bytes of the mesh files, the kind of tissue and the format version. Throws std::runtime_error if a mesh
/// file cannot be read.
std::string content_hash(const Body& body);

/// The same but for a factor common to all its Young's moduli: of the file, whose numbers scale_young() brings to the
/// body's own.
std::string archive_hash(const Body& body);

}  // namespace palpate
