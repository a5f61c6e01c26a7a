#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

namespace palpate {

/// A closed line in a slice, in voxels: (0, 0) is the middle of the slice's first voxel. What it encloses lies on its
/// left, so that an outer border runs counter-clockwise and a hole's clockwise.
using Contour = std::vector<Eigen::Vector2d>;

/// Lines along which values of `width` x `height` voxels are 0, placed evenly between voxels, around what is negative
/// (marching squares; negative voxels that touch by a corner stay apart). Beyond the slice nothing is negative.
std::vector<Contour> level_lines(int width, int height, const std::function<double(int, int)>& value);

/// Around voxels that are set.
std::vector<Contour> outlines_of(int width, int height, const char* inside);

/// Sets voxels whose middles the contours go around, all others not.
void fill_contours(const std::vector<Contour>& contours, int width, int height, char* inside);

/// Points at even distances of about `step` along the contour, three at least.
Contour resampled(const Contour& contour, double step);

double signed_area(const Contour& contour);  ///< [voxels]; positive: counter-clockwise

}  // namespace palpate
