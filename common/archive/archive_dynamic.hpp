#pragma once
#include <cstddef>

#include "common/archive/archive.hpp"
#include "common/archive/hdf5_file.hpp"

namespace palpate {

/// The datasets of tetrahedra that move with inertia and of hybrid bodies. Private to common/tensors: see
/// write_archive() and read_archive().
void write_dynamic_part(Hdf5Writer& file, const Archive& archive);
void read_dynamic_part(const Hdf5Reader& file, ArchivePart part, Archive& archive);

/// Whether sizes and node indices agree with one another and with the archive's other datasets.
bool dynamic_part_fits(const Archive& archive, ArchivePart part);

std::size_t dynamic_payload_bytes(const Archive& archive);

}  // namespace palpate
