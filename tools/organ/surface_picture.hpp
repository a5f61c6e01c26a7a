#pragma once
#include "common/mesh/tet_mesh.hpp"
#include "tools/organ/canvas.hpp"

namespace palpate {

/// Of a part, from 1.
Colour part_colour(int part);

/// A surface and the part that each triangle belongs to, from 1.
struct PartSurface {
  TriangleMesh mesh;
  std::vector<int> part;
};

/// Draws it seen from the side of least x, y and z, flat triangles lit from there; the picture shows a box [m], so that
/// two surfaces are drawn alike.
Image surface_picture(const PartSurface& surface, const Eigen::Vector3d& low, const Eigen::Vector3d& high);

}  // namespace palpate
