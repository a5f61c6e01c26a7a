#pragma once
#include <string>

namespace palpate {

/// Looks at a NIfTI file (.nii, .nii.gz; NIfTI-1 and NIfTI-2) before ITK does, which fills what is not there with zeros
/// and takes all lengths but the spacing for millimetres. A file that does not begin as one is left to ITK. Throws
/// std::runtime_error(reason) where it ends before its last voxel, its compressed bytes are broken, or its lengths are
/// not in millimetres.
void check_nifti_file(const std::string& file);

}  // namespace palpate
