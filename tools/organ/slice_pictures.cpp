#include "tools/organ/slice_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/organ/picture_folder.hpp"

namespace palpate {
namespace {

constexpr int kHeight = 480;  // [pixels] about
constexpr int kRuler = 10;    // [voxels] between two marks
const Colour kStart{0.7f, 0.4f, 0}, kContour{0.3f, 1, 0.3f}, kByHand{1, 0.4f, 1}, kMark{1, 1, 0};

/// Pixels a voxel along x and y.
std::array<int, 2> scale_of(const GridShape& shape) {
  const Eigen::Array2d voxel = shape.spacing.head<2>().array() / shape.spacing.head<2>().minCoeff();
  const double enlarge = std::clamp(std::round(kHeight / (shape.count[1] * voxel.y())), 1.0, 8.0);
  return {static_cast<int>(std::lround(enlarge * voxel.x())), static_cast<int>(std::lround(enlarge * voxel.y()))};
}

/// Grey values that are black and white: all but a hundredth at each end.
GreyRange shades_of(std::vector<float> values) {
  const auto rank = [&](double part) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return static_cast<double>(*at);
  };
  const double low = rank(0.01), high = rank(0.99);
  return {low, std::max(high, low + 1e-6)};
}

Colour shade(const GreyRange& shades, double grey) {
  return Colour::Constant(static_cast<float>((grey - shades.low) / (shades.high - shades.low)));
}

/// [grey per m] within the slice, the steepness across voxels.
float steepness(const ScalarGrid& grey, int i, int j, int k) {
  double square = 0;
  for (int a = 0; a < 2; ++a) {
    const int here = a == 0 ? i : j, low = std::max(here - 1, 0), high = std::min(here + 1, grey.shape.count[a] - 1);
    if (low == high) continue;
    const auto value = [&](int at) {
      return grey.value[a == 0 ? grey.shape.index(at, j, k) : grey.shape.index(i, at, k)];
    };
    const double slope = (value(high) - value(low)) / ((high - low) * grey.shape.spacing[a]);
    square += slope * slope;
  }
  return static_cast<float>(std::sqrt(square));
}

Image half_picture(const GridShape& shape, const SegmentedSlice& slice, const std::function<Colour(int, int)>& colour) {
  SliceCanvas canvas(shape, colour);
  for (const Contour& line : slice.start) canvas.contour(line, kStart);
  for (const MovedContour& moved : slice.moved) canvas.contour(moved.line, slice.by_hand ? kByHand : kContour);
  canvas.ruler();
  return canvas.image();
}

}  // namespace

SliceCanvas::SliceCanvas(const GridShape& shape, const std::function<Colour(int i, int j)>& colour)
    : scale_(scale_of(shape)), canvas_(scale_[0] * shape.count[0], scale_[1] * shape.count[1]) {
  for (int j = 0; j < shape.count[1]; ++j)
    for (int i = 0; i < shape.count[0]; ++i) {
      const Colour of_voxel = colour(i, j);
      for (int y = 0; y < scale_[1]; ++y)
        for (int x = 0; x < scale_[0]; ++x) canvas_.dot(scale_[0] * i + x, scale_[1] * j + y, of_voxel);
    }
}

Eigen::Vector2d SliceCanvas::pixel(const Eigen::Vector2d& x) const {
  return {scale_[0] * (x.x() + 0.5) - 0.5, scale_[1] * (x.y() + 0.5) - 0.5};
}

void SliceCanvas::segment(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Colour& colour) {
  canvas_.line(pixel(a), pixel(b), colour);
}

void SliceCanvas::triangle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                           const Colour& colour) {
  const auto flat = [&](const Eigen::Vector2d& x) { return Eigen::Vector3d(pixel(x).x(), pixel(x).y(), 0); };
  canvas_.triangle(flat(a), flat(b), flat(c), colour);
}

void SliceCanvas::contour(const Contour& line, const Colour& colour) {
  for (std::size_t n = 0; n < line.size(); ++n) segment(line[n], line[(n + 1) % line.size()], colour);
}

void SliceCanvas::ruler() {
  const auto length = [](int voxel) { return voxel % (5 * kRuler) == 0 ? 12 : 6; };
  for (int at = 0; at < image().width / scale_[0]; at += kRuler)
    for (int p = 0; p < length(at); ++p) canvas_.dot(static_cast<int>(pixel({at, 0}).x()), p, kMark);
  for (int at = 0; at < image().height / scale_[1]; at += kRuler)
    for (int p = 0; p < length(at); ++p) canvas_.dot(p, static_cast<int>(pixel({0, at}).y()), kMark);
}

void write_slice_pictures(const ScalarGrid& image, const ScalarGrid& smoothed, const Segmentation& segmentation,
                          const std::filesystem::path& folder) {
  make_picture_folder(folder);
  const GridShape& shape = image.shape;
  std::vector<float> steep;
  steep.reserve(shape.size());
  for (int k = 0; k < shape.count[2]; ++k)
    for (int j = 0; j < shape.count[1]; ++j)
      for (int i = 0; i < shape.count[0]; ++i) steep.push_back(steepness(smoothed, i, j, k));
  const GreyRange greys = shades_of(image.value), steeps = shades_of(steep);
  for (int k = 0; k < shape.count[2]; ++k) {
    const auto shown = [&](const std::vector<float>& values, const GreyRange& shades) {
      return half_picture(shape, segmentation.slices[k],
                          [&](int i, int j) { return shade(shades, values[shape.index(i, j, k)]); });
    };
    write_png(side_by_side(shown(image.value, greys), shown(steep, steeps)),
              folder / fmt::format("slice_{:04}.png", k));
  }
}

}  // namespace palpate
