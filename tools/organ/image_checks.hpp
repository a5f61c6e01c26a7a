#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/organ/distance_grid.hpp"

namespace palpate {

/// A value as a label; `at`: its index in the image. Throws std::runtime_error where it is no whole number, or one of
/// more than 32 bits: cut off, it would be another's label.
std::int32_t label_of(double value, const GridShape& image, std::size_t at);

/// Where a series has its slices.
struct SlicePlaces {
  std::vector<Eigen::Vector3d> first_mm;  ///< the first pixel of each
  Eigen::Vector3d normal;                 ///< of length 1
  double pixel_mm;                        ///< the least extent of one
};

/// Slices are read as evenly spaced along their normal, whatever their places: throws std::runtime_error where they are
/// not, with the place.
void check_even(const SlicePlaces& slices);

}  // namespace palpate
