#include "tools/organ/label_solid.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "tools/organ/thin_walls.hpp"
#include "tools/organ/voxel_pieces.hpp"

namespace palpate {
namespace {

constexpr double kOnSide = 0.1;  // of a gap: what is so near to a side of it lies on it

/// A distance whose level 0 encloses a volume of voxels.
struct Field {
  DistanceGrid grid;
  double level = 0;
  double at(const Eigen::Vector3d& x) const { return grid.at(x) - level; }
  Eigen::Vector3d slope(const Eigen::Vector3d& x) const {
    Eigen::Vector3d slope;
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3d step = 0.5 * grid.shape.spacing[a] * Eigen::Vector3d::Unit(a);
      slope[a] = (grid.at(x + step) - grid.at(x - step)) / grid.shape.spacing[a];
    }
    return slope;
  }
};

/// `width`: [m] of the smoothing along each axis.
Field field_of(const GridShape& shape, const std::vector<char>& inside, const Eigen::Vector3d& width) {
  Field field{distance_to_border(shape, inside)};
  if (width.maxCoeff() > 0) smooth(field.grid, width);
  const double volume = volume_of_voxels(shape, inside);
  double low = -shape.spacing.norm(), high = shape.spacing.norm();
  for (int i = 0; i < 30; ++i) {
    field.level = 0.5 * (low + high);
    (volume_below(field.grid, field.level) < volume ? low : high) = field.level;
  }
  return field;
}

/// [m^2] Of the smooth surface of a solid whose voxels have this border: by the field's slope a face's share of it.
double area_of(const Field& field, const std::vector<Eigen::Vector3d>& border) {
  const Eigen::Vector3d& s = field.grid.shape.spacing;
  double area = 0;
  for (const Eigen::Vector3d& x : border) {
    const Eigen::Vector3d normal = field.slope(x).normalized();
    const Eigen::Vector3d step = ((x - field.grid.shape.origin).array() / s.array()).matrix();
    int axis = 0;  // across which the face lies: half a voxel off
    for (int a = 0; a < 3; ++a)
      if (std::abs(step[a] - std::round(step[a])) > 0.25) axis = a;
    area += std::abs(normal[axis]) * s.prod() / s[axis];
  }
  return area;
}

struct Fields {
  std::vector<Field> of_label;
  Field all;
  DistanceGrid to_gap;  ///< [m] about how far a gap's side lies ahead; < 0 beyond. Without values where there is no gap

  int part(const Eigen::Vector3d& x) const {
    if (all.at(x) >= 0) return 0;
    if (of_label.size() == 1) return 1;
    const auto nearest = std::ranges::min_element(of_label, {}, [&](const Field& field) { return field.at(x); });
    return static_cast<int>(nearest - of_label.begin()) + 1;
  }
  double depth(const Eigen::Vector3d& x) const {
    double least = std::abs(all.at(x));
    if (of_label.size() > 1)
      for (const Field& field : of_label) least = std::min(least, std::abs(field.at(x)));
    return least;
  }
  Eigen::Vector3d nearest(Eigen::Vector3d x) const {
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d slope = all.slope(x);
      if (slope.squaredNorm() > 0.01) x -= all.at(x) / slope.squaredNorm() * slope;
    }
    return x;
  }
};

/// Takes from a label what is nearer to the others' border than half the gap, evenly on both sides, and notes how far
/// that is; returns what is left of its volume [m^3].
double keep_apart(const LabelVoxels& voxels, int label, double gap, const Eigen::Vector3d& width, Fields& fields) {
  Field& field = fields.all;
  constexpr float kNoGap = 1e6;  // [m]
  fields.to_gap = {voxels.shape, std::vector<float>(voxels.shape.size(), kNoGap)};
  for (std::size_t o = 0; o < voxels.labels.size(); ++o) {
    if (static_cast<int>(o) == label) continue;
    const Field other = field_of(voxels.shape, voxels.inside[o], width);
    for (std::size_t i = 0; i < field.grid.value.size(); ++i) {
      const double here = field.grid.value[i] - field.level, there = other.grid.value[i] - other.level;
      const double beyond = 0.5 * (here - there + gap);
      field.grid.value[i] = static_cast<float>(field.level + std::max(here, beyond));
      fields.to_gap.value[i] = std::min(fields.to_gap.value[i], static_cast<float>(-beyond));
    }
  }
  return volume_below(field.grid, field.level);
}

void check_left(const std::string& name, double left, double volume, double gap) {
  constexpr double kLeft = 0.1;  // of its volume
  if (left < kLeft * volume)
    throw std::runtime_error(
        fmt::format("a gap of {:.3g} mm leaves {:.3g} of the {:.3g} ml of '{}': ask for a smaller --gap", 1e3 * gap,
                    1e6 * left, 1e6 * volume, name));
}

std::vector<char> union_of(const LabelVoxels& voxels, const std::vector<int>& labels) {
  std::vector<char> all(voxels.shape.size(), 0);
  for (const int l : labels)
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = all[i] || voxels.inside[l][i];
  return all;
}

/// Some of the border's points, and which way is in.
std::vector<SurfacePoint> points_of(const Field& field, const std::vector<Eigen::Vector3d>& border) {
  std::vector<SurfacePoint> points;
  const std::size_t step = 1 + border.size() / kWallPoints;
  for (std::size_t i = 0; i < border.size(); i += step)
    points.push_back({border[i], -field.slope(border[i]).normalized()});
  return points;
}

/// [m] From x to the nearest voxel that is not inside, or `most`; looks at all that are so near.
double depth_in_voxels(const GridShape& grid, const std::vector<char>& inside, const Eigen::Vector3d& x, double most) {
  const auto voxel_at = [&](const Eigen::Vector3d& place) -> Eigen::Array3i {
    return ((place - grid.origin).array() / grid.spacing.array()).round().cast<int>();
  };
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(most);
  const Eigen::Array3i low = voxel_at(x - reach).max(0);
  const Eigen::Array3i high = voxel_at(x + reach).min(Eigen::Array3i(grid.count[0], grid.count[1], grid.count[2]) - 1);
  double depth = most;
  for (int k = low[2]; k <= high[2]; ++k)
    for (int j = low[1]; j <= high[1]; ++j)
      for (int i = low[0]; i <= high[0]; ++i) {
        if (inside[grid.index(i, j, k)]) continue;
        const Eigen::Vector3d away = (x - grid.place(i, j, k)).cwiseAbs() - 0.5 * grid.spacing;
        depth = std::min(depth, away.cwiseMax(0.0).norm());
      }
  return depth;
}

/// Of the voxels as they are: smoothing closes and opens thin walls. Midway between two voxels that are equally deep
/// the grid has their depth, which is half a voxel too little: of walls of a few voxels that is much.
ThinWall wall_of(const GridShape& grid, const std::vector<char>& inside, const std::vector<SurfacePoint>& points) {
  const double voxel = grid.spacing.minCoeff(), few = 2 * voxel;
  const DistanceGrid sharp = distance_to_border(grid, inside);
  const DepthUpTo depth = [&](const Eigen::Vector3d& x, double most) { return std::min(-sharp.at(x), most); };
  return thin_wall(points, depth, 0.25 * voxel, [&](const Eigen::Vector3d& x, double most) {
    return most > few ? 0 : depth_in_voxels(grid, inside, x, most);
  });
}

/// Smoothing as wide as a wall makes holes in it: makes it a third of that at most along each axis, and says so.
bool smooth_less(const ThinWall& wall, Eigen::Vector3d& width, std::vector<Finding>& findings) {
  constexpr double kOfWall = 1.0 / 3;
  const double most = kOfWall * wall.thickness;
  if (width.maxCoeff() <= most) return false;
  width = width.cwiseMin(most);
  findings.push_back({fmt::format("walls {:.3g} mm thick", 1e3 * wall.thickness),
                      fmt::format("smoothed over {:.2g} mm at most", 1e3 * most),
                      {wall.place}});
  return true;
}

}  // namespace

LabelSolid solid_of(const LabelVoxels& voxels, const std::vector<int>& labels, const LabelShape& wish,
                    std::vector<Finding>& findings) {
  LabelSolid result;
  const GridShape& grid = voxels.shape;
  Eigen::Vector3d width = wish.smoothing * grid.spacing;
  auto fields = std::make_shared<Fields>();
  std::vector<char> all = union_of(voxels, labels);
  if (labels.size() > 1) fill_cavities(grid, all, all, kSmallCavity, "all of them", findings);
  result.border = border_of(grid, all);
  fields->all = field_of(grid, all, width);
  result.solid.wall = wall_of(grid, all, points_of(fields->all, result.border));
  if (smooth_less(result.solid.wall, width, findings)) fields->all = field_of(grid, all, width);
  for (const int l : labels) {
    result.volumes.push_back(volume_of_voxels(grid, voxels.inside[l]));
    fields->of_label.emplace_back();
    if (labels.size() > 1) fields->of_label.back() = field_of(grid, voxels.inside[l], width);
  }
  if (wish.gap > 0) {
    const double left = keep_apart(voxels, labels[0], wish.gap, width, *fields);
    check_left(voxels.labels[labels[0]].name, left, result.volumes[0], wish.gap);
    result.volumes = {left};
    const double on_side = kOnSide * wish.gap;
    result.solid.room = [fields, on_side](const Eigen::Vector3d& x) {
      return std::max(fields->to_gap.at(x) - on_side, 0.0);
    };
  }
  result.measures = {area_of(fields->all, result.border), result.volumes};
  Solid& solid = result.solid;
  solid.parts = static_cast<int>(labels.size());
  solid.part = [fields](const Eigen::Vector3d& x) { return fields->part(x); };
  solid.depth = [fields](const Eigen::Vector3d& x) { return fields->depth(x); };
  solid.nearest = [fields](const Eigen::Vector3d& x) { return fields->nearest(x); };
  solid.low = grid.place(1, 1, 1), solid.high = grid.far_corner() - grid.spacing;
  return result;
}

}  // namespace palpate
