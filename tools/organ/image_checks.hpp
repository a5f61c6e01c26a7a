#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/organ/distance_grid.hpp"

namespace palpate {

/// Makes labels of an image's values as they come.
class LabelTaker {
 public:
  explicit LabelTaker(const GridShape& image) : image_(image) {}

  /// The value as 32 bits of a label; `at`: its index in the image. Throws std::runtime_error where it is no whole
  /// number from kLeastLabel to kMostLabel: cut off, it would be another's label.
  std::int32_t take(double value, std::size_t at);
  /// Volume::is_high of what was taken. Throws std::runtime_error where labels lie below 0 and above 2^31 - 1.
  bool is_high() const;

 private:
  GridShape image_;
  std::optional<std::size_t> negative_, high_;  ///< the first of them
};

/// Throws std::runtime_error where a grey value is no finite number.
void check_finite(const GridShape& image, const std::vector<float>& grey);

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
