#include "tools/organ/surface_solid.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "tools/organ/distance_grid.hpp"
#include "tools/organ/surface_library.hpp"
#include "tools/organ/surface_shells.hpp"
#include "tools/organ/thin_walls.hpp"

namespace palpate {
namespace {

constexpr int kRim = 4;               // cells around the surface
constexpr double kCells = 8e6;        // of the grid
constexpr double kMaxAlong = 1000;    // of these along the longest extent
constexpr double kNoVolume = 1e-9;    // of the area to the power of 1.5
constexpr double kCellsOfWall = 1.5;  // at least, for the grid to tell its sides apart

/// A box is filled with about so many cells, or its longest extent cut into as many as that.
GridShape grid_around(const TriangleMesh& surface) {
  Eigen::Vector3d low = surface.nodes[surface.triangles[0][0]], high = low;
  for (const auto& t : surface.triangles)
    for (const int n : t) low = low.cwiseMin(surface.nodes[n]), high = high.cwiseMax(surface.nodes[n]);
  const double longest = (high - low).maxCoeff();
  const auto cells_of = [&](double cell) { return ((high - low).array() / cell + 2 * kRim).prod(); };
  double cell = longest / kMaxAlong;
  while (cells_of(cell) > kCells) cell *= 1.05;
  GridShape shape{{}, low - Eigen::Vector3d::Constant((kRim + 0.3183) * cell), Eigen::Vector3d::Constant(cell)};
  for (int a = 0; a < 3; ++a) shape.count[a] = static_cast<int>(std::ceil((high - low)[a] / cell)) + 2 * kRim + 1;
  return shape;
}

/// Evenly over the surface; of a triangle that has one, about its middle.
std::vector<SurfacePoint> points_of(const TriangleMesh& surface) {
  std::vector<SurfacePoint> points;
  const double share = surface_area(surface) / static_cast<double>(kWallPoints);
  double due = 0.5;  // points
  for (const auto& [a, b, c] : surface.triangles) {
    const Eigen::Vector3d x = surface.nodes[a], u = surface.nodes[b] - x, v = surface.nodes[c] - x;
    const Eigen::Vector3d normal = u.cross(v);
    due += 0.5 * normal.norm() / share;
    const double count = std::floor(due);
    due -= count;
    for (double i = 0.5, turn = 0.5; i < count; ++i, turn = std::fmod(turn + std::numbers::phi, 1))
      points.push_back({x + std::sqrt(i / count) * ((1 - turn) * u + turn * v), -normal.normalized()});
  }
  return points;
}

/// What the surface goes round at least once; a line that meets an edge twice is set right by those beside it.
std::vector<char> inside_of(const SurfaceTree& tree, const GridShape& shape) {
  std::vector<char> inside(shape.size(), 0);
  for (int k = 0; k < shape.count[2]; ++k)
    for (int j = 0; j < shape.count[1]; ++j) {
      const auto crossings = tree.crossings_along_x(shape.place(0, j, k));
      int turns = 0;
      std::size_t next = 0;
      for (int i = 0; i < shape.count[0] - 1; ++i) {
        for (; next < crossings.size() && crossings[next].first <= i * shape.spacing.x(); ++next)
          turns += crossings[next].second;
        inside[shape.index(i, j, k)] = turns > 0;
      }
    }
  return inside;
}

/// Near the surface the tree says how far it is, and where the grid and it disagree, on which side.
void make_exact_near_surface(DistanceGrid& grid, const SurfaceTree& tree) {
  const double near = 2.5 * grid.shape.spacing.x();
  for (int k = 0; k < grid.shape.count[2]; ++k)
    for (int j = 0; j < grid.shape.count[1]; ++j) {
      std::optional<Eigen::Vector3d> foot;  // the surface's nearest point to the place before, if that is near
      for (int i = 0; i < grid.shape.count[0]; ++i) {
        float& value = grid.value[grid.shape.index(i, j, k)];
        if (std::abs(value) > near) {
          foot.reset();
          continue;
        }
        const Eigen::Vector3d x = grid.shape.place(i, j, k);
        foot = foot ? tree.nearest(x, *foot) : tree.nearest(x);
        value = std::copysign(static_cast<float>((*foot - x).norm()), value);
      }
    }
}

}  // namespace

SurfaceSolid solid_of(const TriangleMesh& surface) {
  if (!(enclosed_volume(surface) > kNoVolume * std::pow(surface_area(surface), 1.5)))
    throw std::runtime_error("the surface encloses no volume");
  const auto tree = std::make_shared<const SurfaceTree>(surface);
  const GridShape shape = grid_around(surface);
  const double cell = shape.spacing.x();
  const ThinWall wall = thin_wall(
      points_of(surface), [&](const Eigen::Vector3d& x, double most) { return tree->distance(x, most); }, 0.01 * cell);
  if (wall.thickness < kCellsOfWall * cell)
    throw std::runtime_error(fmt::format(
        "its walls are {:.3g} mm thick at {}, less than is told apart in a body of that size: {:.3g} mm; cut "
        "it into smaller parts, or have it as a surface of shell elements",
        1e3 * wall.thickness, place_in_mm(wall.place), 1e3 * kCellsOfWall * cell));
  auto distance = std::make_shared<DistanceGrid>(distance_to_border(shape, inside_of(*tree, shape)));
  make_exact_near_surface(*distance, *tree);
  SurfaceSolid result{{}, {surface_area(surface), {enclosed_volume(surface)}}};
  Solid& solid = result.solid;
  solid.part = [distance](const Eigen::Vector3d& x) { return distance->at(x) < 0 ? 1 : 0; };
  solid.depth = [distance](const Eigen::Vector3d& x) { return std::abs(distance->at(x)); };
  solid.nearest = [tree](const Eigen::Vector3d& x) { return tree->nearest(x); };
  solid.low = shape.place(1, 1, 1), solid.high = shape.far_corner() - shape.spacing;
  solid.wall = wall;
  return result;
}

}  // namespace palpate
