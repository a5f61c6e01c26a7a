#include "tools/organ/label_voxels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "common/geometry/joined_sets.hpp"
#include "tools/organ/voxel_pieces.hpp"

namespace palpate {
namespace {

constexpr int kRim = 8;  // voxels around the labels
constexpr std::size_t kMaxLabels = 255;
constexpr int kFewestVoxels = 27;  // of a label: fewer have no shape

/// The part of the image with labels, and a rim around it.
GridShape crop_of(const LabelVolume& volume, const std::vector<NamedLabel>& labels) {
  std::array<int, 3> low = volume.shape.count, high{-1, -1, -1};
  std::size_t at = 0;
  for (int k = 0; k < volume.shape.count[2]; ++k)
    for (int j = 0; j < volume.shape.count[1]; ++j)
      for (int i = 0; i < volume.shape.count[0]; ++i, ++at) {
        if (std::ranges::find(labels, label_at(volume, at), &NamedLabel::label) == labels.end()) continue;
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

std::vector<char> all_voxels_of(const LabelVolume& volume, const GridShape& crop, const NamedLabel& label) {
  std::vector<char> inside(crop.size(), 0);
  const Eigen::Array3i shift = ((crop.origin - volume.shape.origin).array() / crop.spacing.array()).round().cast<int>();
  bool any = false;
  for (int k = kRim; k < crop.count[2] - kRim; ++k)
    for (int j = kRim; j < crop.count[1] - kRim; ++j)
      for (int i = kRim; i < crop.count[0] - kRim; ++i) {
        const bool set = label_at(volume, volume.shape.index(i + shift[0], j + shift[1], k + shift[2])) == label.label;
        inside[crop.index(i, j, k)] = set;
        any = any || set;
      }
  if (!any) throw std::runtime_error(fmt::format("no voxel has the label {}", label.label));
  return inside;
}

void add(const std::vector<char>& more, std::vector<char>& all) {
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = all[i] || more[i];
}

/// Of every voxel the number of its label, from 1; 0: none.
std::vector<unsigned char> numbers_of(const LabelVoxels& voxels) {
  std::vector<unsigned char> number(voxels.shape.size(), 0);
  for (std::size_t l = 0; l < voxels.inside.size(); ++l)
    for (std::size_t i = 0; i < number.size(); ++i)
      if (voxels.inside[l][i]) number[i] = static_cast<unsigned char>(l + 1);
  return number;
}

}  // namespace

double volume_of_voxels(const GridShape& shape, const std::vector<char>& inside) {
  return static_cast<double>(std::ranges::count(inside, 1)) * shape.spacing.prod();
}

LabelVoxels voxels_of(const LabelVolume& volume, const std::vector<NamedLabel>& labels,
                      std::vector<Finding>& findings) {
  if (labels.size() > kMaxLabels)
    throw std::runtime_error(fmt::format("{} labels: {} are taken at once", labels.size(), kMaxLabels));
  LabelVoxels voxels{crop_of(volume, labels), labels, {}};
  std::vector<char> all(voxels.shape.size(), 0);
  for (const NamedLabel& label : labels) {
    voxels.inside.push_back(all_voxels_of(volume, voxels.shape, label));
    keep_largest_piece(voxels.shape, voxels.inside.back(), label.name, findings);
    if (const auto count = std::ranges::count(voxels.inside.back(), 1); count < kFewestVoxels)
      throw std::runtime_error(fmt::format("the label {} has {} voxels that hang together: a body needs {} at least",
                                           label.label, count, kFewestVoxels));
    add(voxels.inside.back(), all);
  }
  for (std::size_t l = 0; l < labels.size(); ++l) {
    fill_cavities(voxels.shape, voxels.inside[l], all, kSmallCavity, labels[l].name, findings);
    add(voxels.inside[l], all);
  }
  return voxels;
}

std::vector<std::vector<int>> touching_labels(const LabelVoxels& voxels) {
  const std::vector<unsigned char> number = numbers_of(voxels);
  JoinedSets sets(voxels.inside.size());
  const std::size_t row = voxels.shape.count[0], layer = row * voxels.shape.count[1];
  for (std::size_t i = layer; i < number.size(); ++i)
    for (const std::size_t step : {std::size_t{1}, row, layer}) {
      const int a = number[i], b = number[i - step];
      if (a != 0 && b != 0 && a != b) sets.join(a - 1, b - 1);
    }
  std::vector<std::vector<int>> together(voxels.inside.size());
  for (int l = 0; l < static_cast<int>(together.size()); ++l) together[sets.leader(l)].push_back(l);
  std::erase_if(together, [](const auto& labels) { return labels.empty(); });
  return together;
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

}  // namespace palpate
