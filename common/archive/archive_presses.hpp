#pragma once
#include <cstddef>

#include "common/archive/archive.hpp"
#include "common/archive/hdf5_file.hpp"

namespace palpate {

/// The datasets of the places at which a body was pressed. Private to common/archive: see write_archive() and
/// read_archive(). Every part of an archive has them.
void write_presses(Hdf5Writer& file, const Archive& archive);
void read_presses(const Hdf5Reader& file, Archive& archive);

/// Whether every place has presses, and linear answers that ascend from above zero.
bool presses_fit(const Archive& archive);

std::size_t presses_payload_bytes(const Archive& archive);

}  // namespace palpate
