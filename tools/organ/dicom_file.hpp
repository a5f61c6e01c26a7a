#pragma once
#include <string>

namespace palpate {

/// Whether a DICOM file holds all of its pixels; those that are compressed are left to who reads them. Throws
/// std::runtime_error(reason) where its header cannot be read.
bool dicom_is_whole(const std::string& file);

/// Throws std::runtime_error: the header of this slice is cut short or damaged.
[[noreturn]] void refuse_header(const std::string& file);

}  // namespace palpate
