#pragma once
#include <optional>

#include "tools/organ/active_contour.hpp"
#include "tools/organ/finding.hpp"
#include "tools/organ/hand_contours.hpp"

namespace palpate {

/// Grey values without most of their noise, in two ways. A Gaussian alone gives values between those of two tissues
/// where they meet, but moves a border of radius r inward by about width^2 / r. Twicing (Tukey, Exploratory Data
/// Analysis, 1977), which smooths what the Gaussian took away and gives it back, leaves borders in place, but goes
/// beyond both values beside them.
struct SmoothedImage {
  double width;       ///< [m] the Gaussian's deviation; 0: the values are as they were
  ScalarGrid gauss;   ///< by the Gaussian
  ScalarGrid twiced;  ///< by twicing
};
SmoothedImage smoothed_image(const ScalarGrid& grey, double width);  ///< width: the Gaussian's deviation [m], or 0

struct SegmentationRules {
  std::optional<GreyRange> range;  ///< none: from the seeds' surroundings
  double neck = 0;                 ///< [m] parts that hang on by less than this are cut off; 0: none
  ContourForces forces;
  HandContours by_hand;
};

struct SegmentedSlice {
  std::vector<Contour> start;  ///< the region's, or from those drawn by hand
  std::vector<MovedContour> moved;
  bool by_hand = false;
  std::size_t voxels = 0;  ///< of the organ that are left in it

  double on_edge() const;  ///< [1] share of all its contours' points
};

struct Segmentation {
  GreyRange range{};
  std::vector<char> inside;  ///< the organ's voxels
  std::vector<SegmentedSlice> slices;
  std::vector<Finding> findings;  ///< places in the image's frame
};

/// An organ's voxels from grey values (TVCG99 sec. 2-1): a region of a range grows from the seeds (indices of
/// voxels), contours drawn by hand take its place in their slices, every slice's other contours move to its edges, and
/// the slices are stacked: a voxel that differs from both its neighbours in the next slices is as they are (but for
/// slices drawn by hand), the largest piece stays, its cavities are filled.
/// Throws std::runtime_error.
Segmentation segment(const SmoothedImage& image, const std::vector<std::size_t>& seeds, const SegmentationRules& rules);

}  // namespace palpate
