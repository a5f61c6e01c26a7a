#pragma once
#include "common/mesh/tet_mesh.hpp"
#include "tools/generate/implicit_shapes.hpp"

namespace palpate {

/// Sphere of 10 f^2 + 2 nodes and 20 f^2 triangles: an icosahedron whose edges are cut into f parts.
TriangleMesh geodesic_sphere(int frequency);

/// Wraps a sphere around a body without holes: morphs the ellipsoid `start` (half axes [m], centred at the
/// origin) into `shape`, with the nodes spread evenly and the edges flipped to Delaunay on the way.
TriangleMesh wrap(const ImplicitShape& shape, const Eigen::Vector3d& start, int frequency);

}  // namespace palpate
