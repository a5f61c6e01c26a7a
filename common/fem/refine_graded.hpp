#pragma once
#include <functional>
#include <span>

#include "common/fem/direct.hpp"

namespace palpate {

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

/// Where a ball is pressed into a body.
struct PressedSpot {
  Eigen::Vector3d point;   ///< [m] of the surface
  Eigen::Vector3d inward;  ///< unit: the press
  double radius;           ///< [m] of the ball
};

/// How fine a mesh under a ball is: edges far away against the body's own and under the ball against its radius [1],
/// by how much they grow per distance between, and how many nodes it may have.
struct Fineness {
  double edge, ball, growth;
  int max_nodes;

  Fineness coarser(double by) const { return {by * edge, by * ball, by * growth, max_nodes}; }
};

/// The body on a mesh that is fine under a ball at each spot. One with too many nodes is made coarser far away and
/// graded faster, in as many strides of 15 % beyond the given ones as it takes; `strides` becomes their number. Throws
/// std::runtime_error where twelve do not help.
StaticProblem refine_under_ball(const StaticProblem& problem, std::span<const PressedSpot> spots,
                                const Fineness& fineness, int& strides);

}  // namespace palpate
