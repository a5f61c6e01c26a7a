#pragma once
#include <array>
#include <vector>

#include "common/view/draw_list.hpp"

namespace palpate {

/// One rigid part of an instrument, in the tip frame [m].
struct InstrumentPart {
  std::vector<Eigen::Vector3f> position, normal;
  std::vector<std::array<int, 3>> triangles;
};

/// An instrument in three parts. Each jaw turns about the tip frame's x axis at z = -hinge, the upper one (y > 0) by
/// +opening/2 towards +y, the lower one the other way. A probe's jaws together are the round tip; a scalpel has its
/// electrode and the insulator in their place; a forceps' hinge is the tip frame's origin.
struct InstrumentShape {
  std::array<InstrumentPart, 3> parts;  ///< shaft, upper jaw, lower jaw
  double hinge = 0;                     ///< [m] behind the tip's centre
};

/// Depends on the view's lengths only.
InstrumentShape make_instrument(const InstrumentView& view);

/// A forceps: shaft, fork and pin, and two tapered jaws with teeth. Each part is made of closed surfaces.
InstrumentShape make_forceps(const InstrumentView& view);

/// Where part `part` of the instrument stands: from the tip frame of the closed instrument to the world.
Eigen::Isometry3d part_pose(const InstrumentView& view, const InstrumentShape& shape, int part);

}  // namespace palpate
