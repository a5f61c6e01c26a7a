#pragma once
#include <cmath>
#include <numbers>

#include "common/mesh/visual_mesh.hpp"

namespace palpate {

/// An ellipsoid about the origin with these half axes [m], in two parts: "north" with texture coordinates (z > 0), and
/// "south" of a colour.
inline VisualMesh ellipsoid_around(const Eigen::Vector3d& half_axes, int rows = 16, int columns = 24) {
  VisualMesh mesh;
  for (const bool north : {true, false}) {
    VisualMesh::Part part;
    part.material = north ? "north" : "south";
    part.textured = north;
    if (!north) part.colour = {0.2, 0.3, 0.1};
    part.first = static_cast<int>(mesh.position.size());
    for (int r = 0; r <= rows; ++r)
      for (int c = 0; c <= columns; ++c) {
        const double up = std::numbers::pi / 2 * r / rows, around = 2 * std::numbers::pi * (c % columns) / columns;
        const double level = r < rows ? std::cos(up) : 0;
        const Eigen::Vector3d on_ball(level * std::cos(around), level * std::sin(around), std::sin(up));
        mesh.position.push_back(
            on_ball.cwiseProduct(Eigen::Vector3d(1, 1, north ? 1 : -1)).cwiseProduct(half_axes).cast<float>());
        mesh.image.emplace_back(static_cast<float>(c) / static_cast<float>(columns),
                                1 - static_cast<float>(r) / static_cast<float>(rows));
        if (r == rows || c == columns) continue;
        const int a = r * (columns + 1) + c, b = a + 1, d = a + columns + 1;
        const auto add = [&](int i, int j, int k) {
          part.triangles.push_back(north ? std::array{i, j, k} : std::array{i, k, j});
        };
        add(a, b, d + 1);
        if (r + 1 < rows) add(a, d + 1, d);
      }
    part.count = static_cast<int>(mesh.position.size()) - part.first;
    mesh.parts.push_back(part);
  }
  join_places(mesh);
  return mesh;
}

}  // namespace palpate
