#pragma once
#include <Eigen/Core>
#include <functional>

namespace palpate {

/// A body as the set where the value is negative; near its surface the value is about the distance [m].
using ImplicitShape = std::function<double(const Eigen::Vector3d&)>;

/// Ellipsoid with the given half axes, its own axes turned by `turn` (columns: where they point).
double ellipsoid(const Eigen::Vector3d& p, const Eigen::Vector3d& centre, const Eigen::Vector3d& half_axes,
                 const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity());

/// Distance to the segment from a to b, less `radius`.
double capsule(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius);

/// Union of two bodies, and what `b` leaves of `a`, with edges rounded over a width of about k [m].
double smooth_union(double a, double b, double k);
double smooth_cut(double a, double b, double k);

/// Gradient of a shape by central differences.
Eigen::Vector3d gradient(const ImplicitShape& shape, const Eigen::Vector3d& p);

/// The nearby point on the surface, by Newton's steps along the gradient.
Eigen::Vector3d project(const ImplicitShape& shape, Eigen::Vector3d p);

}  // namespace palpate
