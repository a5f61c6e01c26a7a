#pragma once
#include <Eigen/Core>
#include <array>
#include <span>

namespace palpate {

/// Vertex normals weighted by triangle area, outward for outward triangles; runs every frame, so no
/// allocation. `positions`: one per vertex [m]; `triangles`: indices into it; `normals`: as many as
/// positions, overwritten with unit vectors. A vertex without area (unused, or of collapsed triangles) gets
/// zero.
void vertex_normals(std::span<const Eigen::Vector3f> positions, std::span<const std::array<int, 3>> triangles,
                    std::span<Eigen::Vector3f> normals);
void vertex_normals(std::span<const Eigen::Vector3d> positions, std::span<const std::array<int, 3>> triangles,
                    std::span<Eigen::Vector3d> normals);

}  // namespace palpate
