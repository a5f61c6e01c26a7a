#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/organ/distance_grid.hpp"

namespace palpate {

/// An image of three dimensions.
template <class T>
struct Volume {
  GridShape shape;  ///< of the values' middles, in a frame of the image's own
  std::vector<T> value;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< from that frame to the world's, a rotation
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();     ///< [m]
  bool is_high = false;  ///< of labels: a value below 0 stands for the one that is 2^32 more

  Eigen::Vector3d in_world(const Eigen::Vector3d& x) const { return turn * x + shift; }
  Eigen::Vector3d in_image(const Eigen::Vector3d& x) const { return turn.transpose() * (x - shift); }
  double diagonal() const { return shape.spacing.norm(); }  ///< [m] of a voxel
};

using LabelVolume = Volume<std::int32_t>;  ///< every value says what is there
using GreyVolume = Volume<float>;          ///< every value is finite

/// Labels are whole numbers from the first to the last of these; of one image not below 0 and above 2^31 - 1 both.
inline constexpr std::int64_t kLeastLabel = -(std::int64_t{1} << 31), kMostLabel = (std::int64_t{1} << 32) - 1;

/// The label of the voxel with this index.
inline std::int64_t label_at(const LabelVolume& volume, std::size_t index) {
  const std::int64_t value = volume.value[index];
  return volume.is_high && value < 0 ? value + (std::int64_t{1} << 32) : value;
}

/// The most voxels that are read.
inline constexpr std::int64_t kMaxVoxels = std::int64_t{1} << 30;

/// Reads INR (.inr, .inr.gz), and with ITK NIfTI (.nii, .nii.gz), MetaImage (.mhd, .mha), NRRD (.nrrd, .nhdr) and a
/// folder with a DICOM series, of several that of the UID `series`; lengths in these are millimetres. Throws
/// std::runtime_error("FILE: reason").
LabelVolume read_label_volume(const std::filesystem::path& file, const std::string& series = "");
GreyVolume read_grey_volume(const std::filesystem::path& file, const std::string& series = "");

/// What the option for `series` says of itself.
inline constexpr const char* kSeriesHelp = "Of a folder with several DICOM series, the one of this UID";

/// "438 x 353 x 165 voxels of 0.617 x 0.617 x 1.333 mm"
std::string say_size(const GridShape& image);

/// The parts of the above, for T = std::int32_t and float. They throw std::runtime_error(reason).
template <class T>
Volume<T> read_inr(const std::filesystem::path& file);
/// Refuses where it was built without ITK.
template <class T>
Volume<T> read_with_image_library(const std::filesystem::path& file, const std::string& series);

}  // namespace palpate
