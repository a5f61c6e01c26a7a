#pragma once
#include <functional>

#include "common/fem/direct.hpp"

namespace palpate::study {

/// Wanted edge length [m] at a place [m].
using SizeField = std::function<double(const Eigen::Vector3d&)>;

/// The same body on a finer mesh: edges longer than the size wanted at their middle are halved, the longest
/// (against that size) first, and all tetrahedra around an edge together, so that the mesh stays conforming.
/// The nodes there were keep their numbers and new ones follow; facets stay flat, so that the shape is the
/// same. A new node is fixed along an axis if its edge lies on the surface and a face of the surface beside
/// it is fixed along that axis at all three corners. Materials follow their tetrahedra. Throws
/// std::runtime_error beyond `max_nodes`.
StaticProblem refine_graded(const StaticProblem& problem, const SizeField& size, int max_nodes);

/// [m] mean edge of the tetrahedra.
double mean_edge(const TetMesh& mesh);

/// [m] Size wanted at a place around a flat disc: `inner` on it, growing by `growth` per metre of distance.
double size_around(const Eigen::Vector3d& place, const Eigen::Vector3d& centre, const Eigen::Vector3d& axis,
                   double radius, double inner, double growth);

}  // namespace palpate::study
