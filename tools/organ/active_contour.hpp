#pragma once
#include "tools/organ/grown_region.hpp"
#include "tools/organ/slice_contours.hpp"

namespace palpate {

/// What moves a contour.
struct ContourForces {
  double reach =
      3;  ///< [voxels] from where a point starts, within which it is drawn to an edge along the normal; 0: it stays
  double stiffness = 1;  ///< against bending other than an ellipse's; 1: a wave of six voxels is halved
};

struct MovedContour {
  Contour line;
  double on_edge = 0;  ///< [1] share of its points that found an edge
};

/// An active contour (Kass, Witkin and Terzopoulos, Int. J. Computer Vision 1, 1988; TVCG99 sec. 2-1) in slice `k` of
/// smoothed grey values: each point is drawn to where, along its normal, the values leave the organ's `level` the
/// fastest, points without such an edge in reach are held by the bending of the line and, weakly, where they started,
/// which is solved for all points at once; so a line does not creep through a gap. Ends when nothing moves, or after
/// some dozen steps. Small contours stay as they are.
MovedContour move_to_edges(const Contour& start, const ScalarGrid& grey, int k, const GreyLevel& level,
                           const ContourForces& forces);

}  // namespace palpate
