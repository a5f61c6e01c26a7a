#include "tools/organ/label_solid.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "tools/organ/voxel_pieces.hpp"

namespace palpate {
namespace {

constexpr int kRim = 8;  // voxels around the labels

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

double volume_of_voxels(const GridShape& shape, const std::vector<char>& inside) {
  return static_cast<double>(std::ranges::count(inside, 1)) * shape.spacing.prod();
}

Field field_of(const GridShape& shape, const std::vector<char>& inside, double smoothing) {
  Field field{distance_to_border(shape, inside)};
  if (smoothing > 0) smooth(field.grid, smoothing * shape.spacing);
  const double volume = volume_of_voxels(shape, inside);
  double low = -shape.spacing.norm(), high = shape.spacing.norm();
  for (int i = 0; i < 30; ++i) {
    field.level = 0.5 * (low + high);
    (volume_below(field.grid, field.level) < volume ? low : high) = field.level;
  }
  return field;
}

/// The part of the image with labels, and a rim around it.
GridShape crop_of(const LabelVolume& volume, const std::vector<NamedLabel>& labels) {
  std::array<int, 3> low = volume.shape.count, high{-1, -1, -1};
  std::size_t at = 0;
  for (int k = 0; k < volume.shape.count[2]; ++k)
    for (int j = 0; j < volume.shape.count[1]; ++j)
      for (int i = 0; i < volume.shape.count[0]; ++i, ++at) {
        if (std::ranges::find(labels, volume.value[at], &NamedLabel::label) == labels.end()) continue;
        const std::array<int, 3> place{i, j, k};
        for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], place[a]), high[a] = std::max(high[a], place[a]);
      }
  if (high[0] < 0) throw std::runtime_error(fmt::format("no voxel has the label {}", labels[0].label));
  GridShape crop = volume.shape;
  for (int a = 0; a < 3; ++a) {
    crop.count[a] = high[a] - low[a] + 1 + 2 * kRim;
    crop.origin[a] += (low[a] - kRim) * crop.spacing[a];
  }
  return crop;
}

std::vector<char> voxels_of(const LabelVolume& volume, const GridShape& crop, const NamedLabel& label) {
  std::vector<char> inside(crop.size(), 0);
  const Eigen::Array3i shift = ((crop.origin - volume.shape.origin).array() / crop.spacing.array()).round().cast<int>();
  bool any = false;
  for (int k = kRim; k < crop.count[2] - kRim; ++k)
    for (int j = kRim; j < crop.count[1] - kRim; ++j)
      for (int i = kRim; i < crop.count[0] - kRim; ++i) {
        const bool set = volume.value[volume.shape.index(i + shift[0], j + shift[1], k + shift[2])] == label.label;
        inside[crop.index(i, j, k)] = set;
        any = any || set;
      }
  if (!any) throw std::runtime_error(fmt::format("no voxel has the label {}", label.label));
  return inside;
}

std::vector<Eigen::Vector3d> border_of(const GridShape& shape, const std::vector<char>& inside) {
  std::vector<Eigen::Vector3d> faces;
  for (int k = 1; k < shape.count[2]; ++k)
    for (int j = 1; j < shape.count[1]; ++j)
      for (int i = 1; i < shape.count[0]; ++i) {
        const bool here = inside[shape.index(i, j, k)];
        const auto note = [&](int di, int dj, int dk) {
          if (inside[shape.index(i - di, j - dj, k - dk)] != here)
            faces.push_back(0.5 * (shape.place(i, j, k) + shape.place(i - di, j - dj, k - dk)));
        };
        note(1, 0, 0), note(0, 1, 0), note(0, 0, 1);
      }
  return faces;
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

}  // namespace

LabelSolid solid_of(const LabelVolume& volume, const std::vector<NamedLabel>& labels, double smoothing) {
  LabelSolid result;
  const GridShape crop = crop_of(volume, labels);
  auto fields = std::make_shared<Fields>();
  std::vector<std::vector<char>> voxels;
  std::vector<char> all(crop.size(), 0);
  for (const NamedLabel& label : labels) {
    voxels.push_back(voxels_of(volume, crop, label));
    keep_largest_piece(crop, voxels.back(), label.name, result.findings);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = all[i] || voxels.back()[i];
  }
  for (std::size_t l = 0; l < labels.size(); ++l) {
    fill_cavities(crop, voxels[l], all, labels[l].name, result.findings);
    result.volumes.push_back(volume_of_voxels(crop, voxels[l]));
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = all[i] || voxels[l][i];
    if (labels.size() > 1) fields->of_label.push_back(field_of(crop, voxels[l], smoothing));
  }
  if (labels.size() > 1) fill_cavities(crop, all, all, "all of them", result.findings);
  fields->all = field_of(crop, all, smoothing);
  if (labels.size() == 1) fields->of_label.resize(1);
  result.border = border_of(crop, all);
  const auto sharp = std::make_shared<DistanceGrid>(distance_to_border(crop, all));
  result.from_voxels = [sharp](const Eigen::Vector3d& x) { return std::abs(sharp->at(x)); };
  result.measures = {area_of(fields->all, result.border), result.volumes};
  Solid& solid = result.solid;
  solid.parts = static_cast<int>(labels.size());
  solid.part = [fields](const Eigen::Vector3d& x) { return fields->part(x); };
  solid.depth = [fields](const Eigen::Vector3d& x) { return fields->depth(x); };
  solid.nearest = [fields](const Eigen::Vector3d& x) { return fields->nearest(x); };
  solid.low = crop.place(1, 1, 1), solid.high = crop.far_corner() - crop.spacing;
  return result;
}

}  // namespace palpate
