#pragma once
#include "common/archive/archive.hpp"
#include "common/archive/hdf5_file.hpp"

namespace palpate {

/// The datasets of a compressed compliance. Private to common/archive: see write_archive() and read_archive().
void write_compressed(Hdf5Writer& file, const Archive& archive);
/// After the surface and its dofs. Nothing is read for ArchivePart::header, the rows of untouchable nodes only for
/// ArchivePart::surface.
void read_compressed(const Hdf5Reader& file, ArchivePart part, Archive& archive);
std::size_t compressed_payload_bytes(const Archive& archive);

}  // namespace palpate
