#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/organ/distance_grid.hpp"

namespace palpate {

/// An image of three dimensions whose every value says what is there.
struct LabelVolume {
  GridShape shape;  ///< of the values' middles, in a frame of the image's own
  std::vector<std::int32_t> label;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< from that frame to the world's, a rotation
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();     ///< [m]

  double diagonal() const { return shape.spacing.norm(); }  ///< [m] of a voxel
};

/// The most voxels that are read.
inline constexpr std::int64_t kMaxVoxels = std::int64_t{1} << 30;

/// Reads INR (.inr, .inr.gz), and with ITK NIfTI (.nii, .nii.gz), MetaImage (.mhd, .mha), NRRD (.nrrd, .nhdr) and a
/// folder with a DICOM series, of several that of the UID `series`; lengths in these are millimetres. Throws
/// std::runtime_error("FILE: reason").
LabelVolume read_label_volume(const std::filesystem::path& file, const std::string& series = "");

/// The parts of the above. They throw std::runtime_error(reason).
LabelVolume read_inr(const std::filesystem::path& file);
/// Refuses where it was built without ITK.
LabelVolume read_with_image_library(const std::filesystem::path& file, const std::string& series);

}  // namespace palpate
