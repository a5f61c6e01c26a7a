#pragma once
#include <cstddef>

#include "common/archive/archive.hpp"
#include "common/archive/hdf5_file.hpp"

namespace palpate {

/// The datasets of a shell's modes. Private to common/tensors: see write_archive() and read_archive(). The
/// header has thickness, frequencies and masses; the shapes come with the touchable part.
void write_modal_part(Hdf5Writer& file, const Archive& archive);
void read_modal_part(const Hdf5Reader& file, ArchivePart part, Archive& archive);

/// Whether sizes agree with one another and with the archive's other datasets.
bool modal_part_fits(const Archive& archive, ArchivePart part);

std::size_t modal_payload_bytes(const Archive& archive);

}  // namespace palpate
