#pragma once
#include "common/mesh/shell_mesh.hpp"

namespace palpate {

/// Where the cystic duct of the example scenes lies: a gentle S from its mouth at the origin to its fixed
/// end. [m]
struct DuctShape {
  double length = 0.060;  ///< along -x
  double drop = 0.009;    ///< of the fixed end, along -z
  double radius = 0.005;  ///< of the wall's middle, in the mean
  double swing = 0.04;    ///< the radius varies by this share
  int around = 20, along = 24;

  Eigen::Vector3d centre(double s) const;  ///< of the wall at 0 (the mouth) .. 1
  double radius_at(double s) const;        ///< of the wall's middle
};

/// The middle surface of the duct's wall: 500 nodes, 960 triangles; group "end0" at the mouth, "end1" at the
/// fixed end. Coordinates are rounded to 0.1 um.
ShellMesh make_duct(const DuctShape& shape = {});

}  // namespace palpate
